#!/usr/bin/env bash
# Runs one benchmark program and keeps its results as JSON, with processor, compiler, commit and load, in
# out/bench/<name>.json.
# usage: cmake/run_benchmark.sh PROGRAM NAME [OPTION OF GOOGLE BENCHMARK...]
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,4p' "$0" >&2; exit 2; }
program=$1
name=$2
shift 2
source_dir=$(cd "$(dirname "$0")/.." && pwd)
results=$source_dir/out/bench
mkdir -p "$results"
commit=$(git -C "$source_dir" describe --always --dirty 2>/dev/null || echo unknown)
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
compiler=$(readelf -p .comment "$program" | sed -n 's/.*\(GCC: .*\)/\1/p' | head -n 1)
"$program" --benchmark_min_time=0.2 --benchmark_context=commit="$commit" --benchmark_context=cpu="$cpu" \
  --benchmark_context=compiler="$compiler" --benchmark_out="$results/$name.json" --benchmark_out_format=json "$@"
# Names of the machine and of its folders say nothing about the results; its load at the end does.
load=$(cut -d ' ' -f 1-3 /proc/loadavg | tr ' ' ',')
sed -i "/\"host_name\":/d; /\"executable\":/d; s/^    \"load_avg\":.*/&\n    \"load_avg_at_end\": [$load],/" "$results/$name.json"
echo "results: $results/$name.json"
