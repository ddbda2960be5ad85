#include "page.hpp"

namespace astroid {

std::string page_style() {
  return R"css(
:root { --ink:#1f2933; --soft:#52606d; --line:#e1e5ea; --faint:#f5f7f9; --accent:#2f6690; --good:#2b9348; --bad:#b23a2b; --warn:#8a6100; }
* { box-sizing:border-box; }
html { scroll-behavior:smooth; }
body { margin:0; color:var(--ink); background:#fff; font:16px/1.55 system-ui,-apple-system,"Segoe UI","DejaVu Sans",Helvetica,Arial,sans-serif; }
.page { max-width:1120px; margin:0 auto; padding:0 24px 64px; }
header { padding:40px 0 8px; }
header p.kind { margin:0; color:var(--accent); font-size:.85rem; font-weight:600; letter-spacing:.06em; text-transform:uppercase; }
h1 { margin:.15em 0 .2em; font-size:1.9rem; line-height:1.2; font-weight:650; overflow-wrap:anywhere; }
h2 { margin:0 0 .6em; font-size:1.3rem; font-weight:650; }
h3 { margin:1.6em 0 .4em; font-size:1.02rem; font-weight:650; }
nav { position:sticky; top:0; z-index:1; background:rgba(255,255,255,.96); border-bottom:1px solid var(--line); margin:0 -24px; padding:8px 24px; font-size:.9rem; display:flex; flex-wrap:wrap; gap:2px 18px; }
a { color:var(--accent); text-decoration:none; } a:hover { text-decoration:underline; }
section { padding-top:34px; scroll-margin-top:32px; }
.verdict { border-left:4px solid var(--accent); background:var(--faint); padding:14px 20px; margin:18px 0 0; }
.verdict p { margin:.25em 0; font-size:1.06rem; }
.met { border-left-color:var(--good); } .missed { border-left-color:var(--bad); }
.tiles { display:grid; grid-template-columns:repeat(auto-fit,minmax(150px,1fr)); gap:12px; margin:18px 0 0; }
.tile { border:1px solid var(--line); border-radius:6px; padding:10px 14px; }
.tile b { display:block; white-space:nowrap; font-size:1.25rem; font-weight:650; font-variant-numeric:tabular-nums; }
.tile span { color:var(--soft); font-size:.84rem; line-height:1.3; display:block; }
.warnings { border-left:4px solid #e09f3e; background:#fdf8ee; padding:10px 20px; margin:18px 0 0; }
.warnings ul { margin:.3em 0; padding-left:1.2em; }
.scroll { overflow-x:auto; margin:.6em 0; }
table { border-collapse:collapse; font-size:.86rem; font-variant-numeric:tabular-nums; min-width:100%; }
th { text-align:right; vertical-align:bottom; font-weight:600; border-bottom:2px solid var(--line); padding:5px 9px; line-height:1.25; }
th .unit { display:block; font-weight:400; color:var(--soft); font-size:.92em; }
td { text-align:right; padding:4px 9px; border-bottom:1px solid var(--line); white-space:nowrap; }
th.text, td.text { text-align:left; } td.text { white-space:normal; overflow-wrap:anywhere; }
tbody tr:hover { background:var(--faint); }
td .err { color:var(--soft); } sup { line-height:0; }
figure { margin:1.2em 0 1.6em; }
figure img { display:block; width:100%; height:auto; }
figure.small img { max-width:640px; }
figcaption, .note { color:var(--soft); font-size:.88rem; max-width:78ch; }
figcaption { margin-top:.5em; } .note { margin:.4em 0; }
pre { background:var(--faint); border:1px solid var(--line); border-radius:6px; padding:14px 16px; overflow-x:auto; font:.82rem/1.5 ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace; }
details summary { cursor:pointer; color:var(--accent); }
.flag { display:inline-block; border:1px solid var(--line); border-radius:4px; padding:0 6px; margin:1px 2px; background:var(--faint); font-size:.93em; white-space:nowrap; }
footer { margin-top:48px; border-top:1px solid var(--line); padding-top:12px; color:var(--soft); font-size:.85rem; }
@media (max-width:600px) { body { font-size:15px; } .page { padding:0 14px 40px; } nav { margin:0 -14px; padding:6px 14px; position:static; } header { padding-top:22px; } h1 { font-size:1.45rem; } th,td { padding:4px 7px; } .tiles { grid-template-columns:1fr 1fr; } }
@media print { nav { display:none; } section { break-inside:auto; } figure, tr { break-inside:avoid; } .scroll { overflow:visible; } a { color:inherit; } }
)css";
}

}  // namespace astroid
