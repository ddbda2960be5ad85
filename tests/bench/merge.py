#!/usr/bin/env python3
"""Merges out/bench/*.json, the programs of one `make bench`, into one file, one benchmark a line.

usage: tests/bench/merge.py [FILE]     (default out/bench/all.json; for the record: reports/bench/<date>-<machine>.json)
"""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RESULTS = ROOT / "out" / "bench"
PROGRAMS = ("kernels", "psf", "photometry", "pipeline", "growth", "stream", "week")
OF_ONE_PROGRAM = ("date", "load_avg", "load_avg_at_end", "commit")
# What the scripts do not read: the mean and scatter of repetitions (the coefficient of variation stays), numbering.
SPARE_AGGREGATES = ("mean", "stddev")
SPARE_KEYS = ("family_index", "per_family_instance_index", "threads", "aggregate_unit")


def main():
    target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else RESULTS / "all.json"
    context, programs, lines = {}, {}, []
    for name in PROGRAMS:
        path = RESULTS / f"{name}.json"
        if not path.exists():
            continue
        results = json.loads(path.read_text())
        context = {key: value for key, value in results["context"].items() if key not in OF_ONE_PROGRAM}
        programs[name] = {key: results["context"][key] for key in OF_ONE_PROGRAM if key in results["context"]}
        for row in results["benchmarks"]:
            if row.get("aggregate_name") not in SPARE_AGGREGATES:
                lines.append(json.dumps({"program": name, **{key: shorter(value) for key, value in row.items() if key not in SPARE_KEYS}}))
    if not programs:
        sys.exit("merge.py: nothing in out/bench; run make bench first")
    sections = [f'"context": {json.dumps({**context, "programs": programs}, indent=1)}']
    if (RESULTS / "assess.json").exists():
        sections.append(f'"week": {json.dumps(json.loads((RESULTS / "assess.json").read_text()), indent=1)}')
    sections.append('"benchmarks": [\n' + ",\n".join(lines) + "\n]")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("{\n" + ",\n".join(sections) + "\n}\n")
    print(f"merged: {target}")


def shorter(value):
    """Six digits: none of the times is better than that."""
    return float(f"{value:.6g}") if isinstance(value, float) else value


if __name__ == "__main__":
    main()
