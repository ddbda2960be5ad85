#include <fmt/format.h>

#include <algorithm>

#include "html.hpp"
#include "page.hpp"

namespace astroid {

namespace {

constexpr std::size_t kMostFlagged = 40;

std::string flag_chips(std::uint32_t flags) {
  std::string text = flag_text(flags);
  std::string out;
  while (!text.empty()) {
    const std::size_t bar = std::min(text.find('|'), text.size());
    out += "<span class=\"flag\">" + html::escape(text.substr(0, bar)) + "</span>";
    text.erase(0, std::min(bar + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string exposure_section(const PageContent& content) {
  const std::string image = figure_block(content, "image");
  const std::string curves = figure_block(content, "light_curves");
  if (image.empty() && curves.empty()) return {};
  return html::section("images",
                       image.empty() ? "Light curves" : (curves.empty() ? "One exposure" : "Image and light curves"),
                       image + curves);
}

std::string flags_section(const PageContent& content) {
  std::vector<const TargetMetrics*> flagged;
  for (const TargetMetrics& target : content.input->targets) {
    if (target.flags != 0) flagged.push_back(&target);
  }
  if (flagged.empty()) return {};
  std::vector<std::vector<std::string>> counts;
  for (const FlagName& flag : flag_names()) {
    const auto n = std::count_if(flagged.begin(), flagged.end(),
                                 [&flag](const TargetMetrics* t) { return (t->flags & flag.bit) != 0; });
    if (n > 0) counts.push_back({flag_chips(flag.bit), html::escape(flag.meaning), fmt::format("{}", n)});
  }
  // Contamination alone is common and has its own section; the list is of what else is wrong, bright stars first.
  std::vector<const TargetMetrics*> listed;
  std::copy_if(flagged.begin(), flagged.end(), std::back_inserter(listed),
               [](const TargetMetrics* t) { return (t->flags & ~measurement_flag::kContaminated) != 0; });
  std::stable_sort(listed.begin(), listed.end(),
                   [](const TargetMetrics* a, const TargetMetrics* b) { return a->mag < b->mag; });
  std::string body = html::table({{"flag", "", true}, {"meaning", "", true}, {"targets", ""}}, counts);
  if (!listed.empty()) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < std::min(kMostFlagged, listed.size()); ++i) {
      const TargetMetrics& t = *listed[i];
      rows.push_back({html::escape(t.id), html::fixed(t.mag, 2), html::fixed(t.x, 1), html::fixed(t.y, 1),
                      html::fixed(1000.0 * t.delta_mag, 1, true), flag_chips(t.flags)});
    }
    body += fmt::format("<h3>{} flagged target{} besides contamination{}</h3>\n", listed.size(),
                        listed.size() == 1 ? "" : "s",
                        listed.size() > kMostFlagged ? fmt::format(", the {} brightest", kMostFlagged) : "");
    body += html::table({{"target", "", true},
                         {"magnitude", ""},
                         {"x", "px"},
                         {"y", "px"},
                         {"measured − true", "mmag"},
                         {"flags", "", true}},
                        rows);
  }
  return html::section("flags", "Flagged targets", body);
}

std::string plan_section(const PageContent& content) {
  if (content.input->plan.empty()) return {};
  return html::section("plan", "The plan", "<pre>" + html::escape(content.input->plan) + "</pre>\n");
}

std::string configuration_section(const PageContent& content) {
  const auto& parameters = content.input->configuration;
  if (parameters.empty()) return {};
  const std::vector<html::TableColumn> columns{
      {"parameter", "", true}, {"value", "", true}, {"unit", "", true}, {"from", "", true}};
  std::vector<std::vector<std::string>> given;
  std::vector<std::vector<std::string>> defaults;
  for (const ReportParameter& p : parameters) {
    auto& rows = p.origin == "default" ? defaults : given;
    rows.push_back({html::escape(p.path), html::escape(p.value), html::escape(p.unit), html::escape(p.origin)});
  }
  std::string body;
  if (!given.empty()) body += html::table(columns, given);
  if (!defaults.empty()) {
    body += fmt::format("<details><summary>{} parameters with their default</summary>{}</details>\n", defaults.size(),
                        html::table(columns, defaults));
  }
  body += "<p class=\"note\">" + html::links({{"config.xml", "../config.xml"}}) + "</p>\n";
  return html::section("configuration", "Configuration", body);
}

std::string provenance_section(const PageContent& content) {
  const auto& provenance = content.input->provenance;
  if (provenance.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  rows.reserve(provenance.size());
  for (const auto& [name, value] : provenance) rows.push_back({html::escape(name), html::escape(value)});
  return html::section("provenance", "Provenance",
                       html::table({{"", "", true}, {"", "", true}}, rows) + "<p class=\"note\">" +
                           html::links({{"run.json", "../run.json"}}) + "</p>\n");
}

}  // namespace astroid
