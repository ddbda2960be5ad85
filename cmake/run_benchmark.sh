#!/usr/bin/env bash
# Runs one benchmark program and keeps its results as JSON, with processor, compiler and commit, in out/bench/<name>.json.
# usage: cmake/run_benchmark.sh PROGRAM NAME
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,3p' "$0" >&2; exit 2; }
source_dir=$(cd "$(dirname "$0")/.." && pwd)
results=$source_dir/out/bench
mkdir -p "$results"
commit=$(git -C "$source_dir" describe --always --dirty 2>/dev/null || echo unknown)
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
compiler=$(readelf -p .comment "$1" | sed -n 's/.*\(GCC: .*\)/\1/p' | head -n 1)
"$1" --benchmark_min_time=0.2 --benchmark_context=commit="$commit" --benchmark_context=cpu="$cpu" \
  --benchmark_context=compiler="$compiler" --benchmark_out="$results/$2.json" --benchmark_out_format=json
# Names of the machine and of its folders say nothing about the results.
sed -i '/"host_name":/d; /"executable":/d' "$results/$2.json"
echo "results: $results/$2.json"
