#!/usr/bin/env bash
# Runs one benchmark program and keeps its results as JSON, with machine and commit, in out/bench/<name>.json.
# usage: cmake/run_benchmark.sh PROGRAM NAME
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,3p' "$0" >&2; exit 2; }
results=$(dirname "$0")/../out/bench
mkdir -p "$results"
commit=$(git -C "$(dirname "$0")" describe --always --dirty 2>/dev/null || echo unknown)
exec "$1" --benchmark_min_time=0.2 --benchmark_context=commit="$commit" \
  --benchmark_out="$results/$2.json" --benchmark_out_format=json
