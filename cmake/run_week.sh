#!/usr/bin/env bash
# Assesses the preset of a week, from catalogue to report, and keeps the timings of its run.json in out/bench/assess.json.
# The products, 3 GB, are removed.
# usage: cmake/run_week.sh ASTROID
set -euo pipefail
[ $# -eq 1 ] || { sed -n '2,4p' "$0" >&2; exit 2; }
source_dir=$(cd "$(dirname "$0")/.." && pwd)
results=$source_dir/out/bench
products=$source_dir/out/bench-week
mkdir -p "$results"
cd "$source_dir"
trap 'rm -rf "$products" "$products.partial"' EXIT
load() { cut -d ' ' -f 1-3 /proc/loadavg | tr ' ' ','; }
before=$(load)
begin=$(date +%s.%N)
"$1" assess apps/missions/plato-week.xml -o "$products" --overwrite
end=$(date +%s.%N)
python3 - "$products/run.json" "$results/assess.json" "$before" "$(load)" "$begin" "$end" \
  "$(git describe --always --dirty 2>/dev/null || echo unknown)" <<'PYTHON'
import json, sys
source, target, before, after, begin, end, commit = sys.argv[1:]
run = json.load(open(source))
kept = ("written", "threads", "exposures", "stars", "pixels", "timings_seconds", "seconds_per_exposure",
        "effects_cpu_seconds", "peak_memory_bytes")
week = {key: run[key] for key in kept}
week.update(commit=commit, wall_seconds=round(float(end) - float(begin), 2),
            bytes=sum(product["bytes"] for product in run["products"]),
            load_avg=json.loads(f"[{before}]"), load_avg_at_end=json.loads(f"[{after}]"))
json.dump(week, open(target, "w"), indent=2)
PYTHON
echo "results: $results/assess.json"
