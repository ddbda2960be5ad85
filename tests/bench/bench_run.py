"""A run of the benchmarks, as merge.py leaves it: what the scripts beside this file read."""

import json
import re


class Run:
    """The merged results of one run."""

    def __init__(self, path):
        self.data = json.loads(path.read_text())
        self.context = self.data["context"]
        self.week = self.data.get("week")

    def rows(self, benchmark, **wanted):
        """Rows of a benchmark in order, each with its arguments under "args": `wanted` are those asked for.

        Of repeated ones the median, or the smallest where that was taken.
        """
        found = []
        for row in self.data["benchmarks"]:
            name, args = parse(row["run_name"])
            if name != benchmark or row.get("error_occurred"):
                continue
            if row["run_type"] == "aggregate" and row["aggregate_name"] not in ("median", "smallest"):
                continue
            if all(args.get(key) == value for key, value in wanted.items()):
                found.append({**row, "args": args})
        best = {row["run_name"] for row in found if row.get("aggregate_name") == "smallest"}
        return [row for row in found if row["run_name"] not in best or row.get("aggregate_name") == "smallest"]

    def row(self, benchmark, **wanted):
        """The only such row, or None."""
        rows = self.rows(benchmark, **wanted)
        return rows[0] if rows else None

    def labelled(self, benchmark, label):
        """The row of a benchmark with this label, or None."""
        return next((row for row in self.rows(benchmark) if row.get("label") == label), None)

    def kernels(self):
        """{kernel: {instruction set: ns a pixel}}, in the order of the run."""
        table = {}
        for row in self.data["benchmarks"]:
            if row["run_name"].startswith(("BM_PixelNoise/", "BM_Plane/")):
                _, kernel, target = row["run_name"].split("/")
                table.setdefault(kernel, {})[target] = 1e9 * row["time/pixel"]
        return table

    def effects(self, scene):
        """[(effect, ms)] of a scene of BM_Effects, in the order of an exposure."""
        order = ("jitter-model", "stars", "sky", "prnu", "dark-current", "photon-noise", "full-well", "readout-noise", "gain", "bias", "adc")
        row = self.labelled("BM_Effects", scene)
        return [(effect, row[f"{effect} ms"]) for effect in order if row and f"{effect} ms" in row]


def parse(run_name):
    """The name of a benchmark and its numbered arguments."""
    parts = run_name.split("/")
    args = {}
    for part in parts[1:]:
        match = re.fullmatch(r"([^:]+):(-?\d+)", part)
        if match:
            args[match[1]] = int(match[2])
    return parts[0], args
