#!/usr/bin/env python3
"""Prints the tables of docs/performance.md from a merged run, or writes them into the page between its marks.

A table stands between <!-- table: NAME --> and <!-- end -->.
usage: tests/bench/tables.py REPORT.json [--update docs/performance.md]
"""

import pathlib
import re
import sys

from bench_run import Run

MARK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
TARGETS = {"AVX3": "AVX-512", "AVX2": "AVX2", "SSE4": "SSE4", "SSSE3": "SSSE3", "scalar": "scalar twin"}
SCENES = ("reference", "everything", "static")


def table(head, rows):
    """Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines)


def number(value):
    """Three digits, no more than two decimals."""
    if value is None:
        return "–"
    if abs(value) >= 1000 or (value and value == round(value)):
        return f"{value:,.0f}"
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


def ms_of(run, scene, target="AVX3"):
    """Milliseconds of an exposure, or None where the processor lacks the instruction set."""
    row = run.labelled("BM_Exposure", f"{scene}, {target}")
    return row["ms"] if row else None


def machine(run):
    """Where, when and with what the run was made."""
    context, programs = run.context, run.context["programs"]
    loads = [row[key][0] for row in programs.values() for key in ("load_avg", "load_avg_at_end") if key in row]
    caches = ", ".join(f'{cache["size"] // 1024} KiB L{cache["level"]}' for cache in context["caches"] if cache["type"] != "Instruction")
    dates = sorted(row["date"] for row in programs.values())
    return table(["", ""], [
        ["date, commit", f'{dates[0][:16].replace("T", " ")} to {dates[-1][11:16]} UTC, {", ".join(sorted({row["commit"] for row in programs.values()}))}'],
        ["processor", f'{context["cpu"]}, {context["num_cpus"]} virtual cores, {context["mhz_per_cpu"] / 1000:.1f} GHz; {caches}'],
        ["compiler", context["compiler"].removeprefix("GCC: ")],
        ["load average", f"{min(loads):.1f} to {max(loads):.1f} while it ran, of which the run itself is 1"]])


def exposure(run):
    """The whole exposure by instruction set."""
    rows = []
    for target, name in TARGETS.items():
        times = [ms_of(run, scene, target) for scene in SCENES]
        if times[0]:
            side = 1024
            rows.append([name, *(number(ms) for ms in times), number(1e6 * times[0] / side**2), number(1000 / times[0])])
    return table(["instruction set", "reference, ms", "everything, ms", "static, ms", "reference, ns/px", "exposures/s"], rows)


LIMITS = {
    "jitter-model": "a look-up: the attitude of a run is computed once",
    "stars": "70 ns to look up two profiles and set up, then a vector a row; most stars cross two strips",
    "photon noise": "arithmetic: ten rounds of Philox, a normal quantile, an expansion; close calls again in double",
    "readout-noise": "arithmetic: ten rounds of Philox and a normal quantile",
    "prnu": "a map of 4 MB, from beyond the second cache",
    "dark-current": "a map of 4 MB, from beyond the second cache",
    "full-well": "a look at each pixel; only columns that hold a full one are worked on",
    "adc": "writes the frame and its flags, the only planes that go to memory",
}


def stages(run):
    """Stage by stage."""
    scenes = {scene: dict(run.effects(scene)) for scene in SCENES}
    rows = []
    for effect in scenes["everything"]:
        cells = [number(scenes[scene].get(effect)) for scene in SCENES]
        limit = LIMITS.get(effect) or LIMITS.get(effect.replace("-", " ")) or "one operation a pixel, in the cache"
        rows.append([effect.replace("-", " "), *cells, number(1e6 * scenes["everything"][effect] / 1024**2), limit])
    total = [sum(scenes[scene].values()) for scene in SCENES]
    rows.append(["**all**", *(f"**{number(ms)}**" for ms in total), f"**{number(1e6 * total[1] / 1024**2)}**", ""])
    return table(["stage", "reference, ms", "everything, ms", "static, ms", "ns/px", "what it is"], rows)


def after(run):
    """What comes after an exposure."""
    rows = []
    for background, name in ((0, "known"), (1, "local")):
        row = run.row("BM_MeasureAllStars", background=background)
        if row:
            rows.append([f"photometry of 5000 stars in one frame, {name} background", number(row["ms"]), f'{number(row["ns/star"])} ns a star'])
    for background, name in ((0, "known"), (1, "local")):
        row = next((row for row in run.rows("BM_ApplyBatch", background=background, frames=16)
                    if "saturated stars:30" in row["run_name"]), None)
        if row:
            rows.append([f"photometry of 32,240 stars in a batch of 16 frames, {name} background", number(row["cpu_time"] / 16000),
                         f'{number(1e9 / row["items_per_second"])} ns a star'])
    row = run.row("BM_WriteImage")
    if row:
        rows.append(["writing a 16-bit FITS image with checksums", number(row["ms"]), f'{number(row["ns/pixel"])} ns a pixel'])
    row = run.row("BM_PlanReference")
    if row:
        rows.append(["once: scene and plan", number(row["cpu_time"]), ""])
    row = run.row("BM_BuildEstimatorsOfReference")
    if row:
        rows.append(["once: estimators of 5000 stars", number(row["ms"]), f'{number(row["ns/star"] / 1000)} µs a star'])
    return table(["", "ms", ""], rows)


def effects_off(run):
    """What an effect costs, and what switching it off saves."""
    names = {"PRNU": "prnu", "dark current": "dark-current", "full well": "full-well", "readout noise": "readout-noise"}
    own = dict(run.effects("everything"))
    rows = []
    for row in run.rows("BM_EffectOff"):
        cost = own.get(names.get(row["label"], row["label"]))
        rows.append([row["label"], number(cost), number(row["saved ms"])])
    return table(["effect", "its own time, ms", "saved when off, ms"], rows)


def kernels(run):
    """Nanoseconds a pixel."""
    data = run.kernels()
    targets = [target for target in TARGETS if any(target in times for times in data.values())]
    rows = [[kernel, *(number(times.get(target)) for target in targets)] for kernel, times in data.items()]
    return table(["ns a pixel", *(TARGETS[target] for target in targets)], rows)


def stars(run):
    """Nanoseconds a star by stamp size."""
    sides = sorted({row["args"]["side"] for row in run.rows("BM_AddStar")})
    rows = []
    for rendering in range(4):
        fast = {row["args"]["side"]: row for row in run.rows("BM_AddStar", rendering=rendering)}
        slow = {row["args"]["side"]: row for row in run.rows("BM_IntegrateAndAdd", rendering=rendering)}
        if fast:
            rows.append([fast[sides[0]]["label"], *(f'{number(fast[side]["cpu_time"])} ({number(slow[side]["cpu_time"])})' for side in sides)])
    return table(["ns a star", *(f"{side} × {side} px" for side in sides)], rows)


def threads(run):
    """One and two threads."""
    rows = []
    for week in (0, 1):
        runs = run.rows("BM_GrowthThreads", week=week)
        alone = runs[0]
        for row in runs:
            rows.append([row["label"], row["args"]["threads"], number(row["wall ms"]), number(row["CPU ms"]),
                         f'{alone["wall ms"] / row["wall ms"]:.2f}', f'{row["args"]["threads"] * alone["CPU ms"] / row["CPU ms"]:.2f}'])
    return table(["scene", "threads", "wall, ms an exposure", "CPU, ms an exposure", "speed-up", "speed-up on idle cores"], rows)


def windows(run):
    """Windows against the full frame."""
    rows = []
    full = {row["args"]["targets"]: row for row in run.rows("BM_Windows", window=0)}
    for row in run.rows("BM_Windows"):
        if row["args"]["window"] == 0:
            continue
        frame = full[row["args"]["targets"]]
        side = row["args"]["window"]
        rows.append([f'{row["args"]["targets"]} of {side} × {side} px', number(row["pixels"]), f'{100 * row["pixels"] / frame["pixels"]:.2g} %',
                     number(row["ms"]), f'{100 * row["ms"] / frame["ms"]:.2g} %', number(row["ns/pixel"])])
    frame = full[max(full)]
    rows.append(["full frame", number(frame["pixels"]), "100 %", number(frame["ms"]), "100 %", number(frame["ns/pixel"])])
    return table(["windows", "pixels", "of the frame", "ms", "of the frame's time", "ns/px"], rows)


def memory(run):
    """Peak of a stream against its length."""
    rows = [[number(row["args"]["exposures"]), number(1000 * row["CPU ms"]), number(row["peak MiB"])] for row in run.rows("BM_GrowthExposures")]
    return table(["exposures", "µs of CPU each", "MiB at most"], rows)


def idle_week(data):
    """Seconds from catalogue to report if the threads of the stream had had a core each."""
    times = data["timings_seconds"]
    stream = sum(times[stage] for stage in ("simulate_cpu", "measure_cpu", "images_cpu", "statistics", "light_curves"))
    return data["wall_seconds"] - times["exposures_wall"] + stream / data["threads"]


def week(run):
    """Where the week's time goes."""
    data = run.week
    if not data:
        return "not measured\n"
    times, effects = data["timings_seconds"], data["effects_cpu_seconds"]
    per_star = 1e9 / (data["exposures"] * data["stars"])
    arithmetic = sum(effects.get(name, 0.0) for name in ("sky", "prnu", "dark-current", "full-well", "gain", "bias", "adc"))
    rows = [["stars (a sum of maps)", number(effects["stars"]), f'{number(1e9 * effects["stars"] / data["exposures"] / data["pixels"])} ns a pixel'],
            ["photon noise", number(effects["photon-noise"]), f'{number(1e9 * effects["photon-noise"] / data["exposures"] / data["pixels"])} ns a pixel'],
            ["readout noise", number(effects["readout-noise"]), f'{number(1e9 * effects["readout-noise"] / data["exposures"] / data["pixels"])} ns a pixel'],
            ["full well, gain, bias, ADC", number(arithmetic), f'{number(1e9 * arithmetic / data["exposures"] / data["pixels"])} ns a pixel'],
            ["photometry", number(times["measure_cpu"]), f'{number(times["measure_cpu"] * per_star)} ns a star and exposure'],
            ["statistics", number(times["statistics"]), f'{number(times["statistics"] * per_star)} ns a star and exposure'],
            ["light curves", number(times["light_curves"]), f'{number(data["bytes"] / 1e9)} GB of products'],
            ["once: patterns, attitude", number(times["prepare"]), ""],
            ["**exposures, wall**", f'**{number(times["exposures_wall"])}**', f'{data["threads"]} threads'],
            ["page, figures, checksums, wall", number(times["analyse"]), ""],
            ["from catalogue to report on idle cores, from CPU time", number(idle_week(data)), f'{data["threads"]} threads'],
            ["**from catalogue to report, wall**", f'**{number(data["wall_seconds"])}**',
             f'load average {data["load_avg"][0]:.1f} before, {data["load_avg_at_end"][0]:.1f} after'],
            ["memory, at most", f'{data["peak_memory_bytes"] / 2**20:.0f} MiB', ""]]
    return table(["the week", "s", ""], rows)


def plan(run):
    """Predicted and measured times."""
    rows = []

    def add(name, predicted, measured):
        rows.append([name, number(predicted), number(measured), f"{100 * (predicted / measured - 1):+.0f} %"])

    for scene, name in zip(SCENES, ("reference exposure", "with every effect", "static")):
        row = run.labelled("BM_Exposure", f"{scene}, AVX3")
        if row:
            add(name, row["predicted ms"], row["ms"])
    for stars_of in (1, 20000, 80000):
        row = run.row("BM_GrowthStars", stars=stars_of)
        add(f'{stars_of:,} star{"s" if stars_of > 1 else ""}', row["predicted ms"], row["ms"])
    for side in (256, 4096):
        row = run.row("BM_GrowthPixels", side=side)
        add(f"{side}² px", row["predicted ms"], row["ms"])
    for side in (6, 12):
        row = run.row("BM_Windows", targets=1000, window=side)
        add(f"1000 windows of {side} × {side} px", row["predicted ms"], row["ms"])
    for benchmark, key, value, name in (("BM_GrowthGaussian", "sigma", 300, "Gaussian PSF of σ 3 px"), ("BM_GrowthTable", "half-width", 5, "PSF of a table, 11 px")):
        row = run.row(benchmark, **{key: value})
        add(name, row["predicted ms"], row["ms"])
    if run.week:
        add("the week", 1000 * run.week["seconds_per_exposure"]["predicted"], 1000 * run.week["seconds_per_exposure"]["measured"])
    return table(["", "predicted, ms", "measured, ms", "off by"], rows)


def aims(run):
    """What was aimed at and what came out."""
    rows = []

    def add(what, aim, value, unit, most=True):
        if value is not None:
            met = value <= aim if most else value >= aim
            rows.append([what, f'{"≤" if most else "≥"} {aim:g}{unit}', f"{number(value)}{unit}", "yes" if met else "**no**"])

    add("reference exposure, AVX-512", 6, ms_of(run, "reference"), " ms")
    add("reference exposure, AVX2", 10, ms_of(run, "reference", "AVX2"), " ms")
    add("static scene, AVX-512", 4.5, ms_of(run, "static"), " ms")
    row = run.row("BM_WriteImage")
    add("FITS file of each exposure, more", 2, row and row["ms"], " ms")
    for week_scene, name in ((0, "reference"), (1, "week")):
        rows_of = run.rows("BM_GrowthThreads", week=week_scene)
        if len(rows_of) > 1:
            add(f"two cores, {name}, wall time", 1.8, rows_of[0]["wall ms"] / rows_of[1]["wall ms"], "×", most=False)
            add(f"two cores, {name}, from CPU time", 1.8, 2 * rows_of[0]["CPU ms"] / rows_of[1]["CPU ms"], "×", most=False)
    if run.week:
        add("the week, catalogue to report, wall time", 90, run.week["wall_seconds"], " s")
        add("the week, catalogue to report, from CPU time", 90, idle_week(run.week), " s")
        add("the week, memory", 2, run.week["peak_memory_bytes"] / 2**30, " GiB")
    draws = run.kernels()
    for target, aim in (("AVX3", 2.5), ("AVX2", 4.0)):
        for kernel in ("added normals", "Poisson of mean 945"):
            add(f"{kernel}, {TARGETS[target]}", aim, draws.get(kernel, {}).get(target), " ns")
    return table(["", "aim", "measured", "met"], rows)


TABLES = {"machine": machine, "aims": aims, "exposure": exposure, "stages": stages, "after": after, "effects-off": effects_off,
          "kernels": kernels, "stars": stars, "threads": threads, "windows": windows, "memory": memory, "week": week, "plan": plan}


def main():
    arguments = sys.argv[1:]
    if len(arguments) not in (1, 3) or (len(arguments) == 3 and arguments[1] != "--update"):
        sys.exit(__doc__)
    run = Run(pathlib.Path(arguments[0]))
    if len(arguments) == 1:
        for name, make in TABLES.items():
            print(f"{name}\n\n{make(run)}")
        return
    page = pathlib.Path(arguments[2])
    page.write_text(MARK.sub(lambda mark: f"{mark[1]}{TABLES[mark[2]](run)}{mark[3]}", page.read_text()))


if __name__ == "__main__":
    main()
