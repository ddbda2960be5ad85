#!/usr/bin/env python3
"""Draws the figures of docs/performance.md from a merged run: docs/figures/performance_*.png, with gnuplot.

usage: tests/bench/plot_growth.py REPORT.json [FOLDER]
"""

import pathlib
import subprocess
import sys

from bench_run import Run

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# Okabe and Ito: told apart by the colour-blind.
BLUE, ORANGE, GREEN, RED, PURPLE, SKY, BLACK, GREY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#222222", "#888888")

STYLE = """
set terminal pngcairo size {width},{height} font "DejaVu Sans,{font}" linewidth 1.6 background "#ffffff"
set output "{output}"
set border 3 linecolor rgb "#888888" linewidth 0.7
set tics nomirror textcolor rgb "#222222"
set grid linecolor rgb "#cccccc" linewidth 0.5
set key textcolor rgb "#222222" samplen 2
set title font ",{title}" textcolor rgb "#222222"
"""


class Figure:
    """A gnuplot script in the making: one plot, or panels in rows and columns."""

    def __init__(self, path, width, height, rows=1, columns=1):
        self.script = STYLE.format(width=width, height=height, font=19, title=21, output=path)
        if rows * columns > 1:
            self.script += f"set multiplot layout {rows},{columns} margins {0.2 / columns},{1 - 0.06 / columns},0.09,0.945 spacing {0.27 / columns},0.16\n"
        self.blocks = 0

    def data(self, rows):
        """A block of data; returns its name."""
        self.blocks += 1
        lines = "\n".join(" ".join(str(value) for value in row) for row in rows)
        self.script += f"$data{self.blocks} << EOD\n{lines}\nEOD\n"
        return f"$data{self.blocks}"

    def panel(self, title, settings, curves):
        """@param curves  of plot, with the name of their data."""
        self.script += f'set title "{title}"\n{settings}\nplot ' + ", \\\n  ".join(curves) + "\nreset\n"
        self.script += "\n".join(STYLE.splitlines()[3:-1]) + '\nset title font ",21" textcolor rgb "#222222"\n'

    def draw(self):
        subprocess.run(["gnuplot"], input=self.script, text=True, check=True)


def points(data, title, colour, shape=7, columns="1:2"):
    return f'{data} using {columns} with linespoints pointtype {shape} pointsize 1.4 linecolor rgb "{colour}" title "{title}"'


def line(data, title, colour, columns="1:2", dash=2):
    return f'{data} using {columns} with lines dashtype {dash} linewidth 1.2 linecolor rgb "{colour}" title "{title}"'


def growth(run, path):
    """Growth with stars, pixels, windows, exposures and threads."""
    figure = Figure(path, 1950, 1150, 2, 3)
    stars = [(row["args"]["stars"], row["ms"], row["predicted ms"]) for row in run.rows("BM_GrowthStars")]
    data = figure.data(stars)
    top = 1.35 * max(max(row[1:]) for row in stars)
    figure.panel("more stars on 1024² px", f"""set logscale x; set format x "10^{{%T}}"; set xrange [1:1e5]; set yrange [0:{top}]
set xlabel "stars"; set ylabel "ms an exposure"; set key bottom left Left reverse""",
                 [points(data, "measured", BLUE), line(data, "predicted by the plan", GREY, "1:3")])

    pixels = [(row["args"]["side"] ** 2 / 1e6, row["ms"], row["predicted ms"]) for row in run.rows("BM_GrowthPixels")]
    data = figure.data(pixels)
    figure.panel("more pixels, as many stars on each", """set logscale xy; set xrange [0.05:20]; set yrange [0.1:300]
set xlabel "million pixels"; set ylabel "ms an exposure"; set key top left Left reverse
set xtics (0.1, 0.3, 1, 3, 10); set ytics (0.1, 0.3, 1, 3, 10, 30, 100, 300)""",
                 [points(data, "measured", BLUE), line(data, "predicted by the plan", GREY, "1:3")])

    frame = run.rows("BM_Windows", window=0)[-1]
    curves = []
    for side, colour, shape in ((6, ORANGE, 5), (12, BLUE, 7)):
        rows = [(row["pixels"] / 1e3, row["ms"]) for row in run.rows("BM_Windows", window=side)]
        curves.append(points(figure.data(rows), f"{side} × {side} px", colour, shape))
    curves.append(f'{1e3 * frame["ms"] / frame["pixels"]} * x with lines dashtype 2 linewidth 1.2 linecolor rgb "{GREY}" title "a share of the full frame"')
    figure.panel("windows of the 1024² px", """set logscale xy; set xrange [2:2000]; set yrange [0.01:100]
set xlabel "thousand pixels in windows"; set ylabel "ms an exposure"; set key top left Left reverse
set xtics (3, 10, 30, 100, 300, 1000); set ytics (0.01, 0.03, 0.1, 0.3, 1, 3, 10)""", curves)

    exposures = [(row["args"]["exposures"], row["peak MiB"], 1000 * row["CPU ms"]) for row in run.rows("BM_GrowthExposures")]
    data = figure.data(exposures)
    for title, label, column, colour in (("longer series: time", "µs of CPU an exposure", 2, BLUE), ("longer series: memory", "MiB at most", 1, RED)):
        top = 1.35 * max(row[column] for row in exposures)
        figure.panel(title, f"""set logscale x; set format x "10^{{%T}}"; set xrange [30:5e4]; set yrange [0:{top}]
set xlabel "exposures of 128² px with 500 stars"; set ylabel "{label}"; unset key""", [points(data, "", colour, 7, f"1:{column + 1}")])

    curves, top = [], 0.0
    for week, name, colour, shape in ((0, "reference", BLUE, 7), (1, "week", ORANGE, 5)):
        rows = run.rows("BM_GrowthThreads", week=week)
        alone = rows[0]
        speed = [(n, alone["wall ms"] / row["wall ms"], n * alone["CPU ms"] / row["CPU ms"]) for row in rows for n in (row["args"]["threads"],)]
        top = max(top, *(max(row) for row in speed))
        data = figure.data(speed)
        curves += [points(data, f"{name}, as it was", colour, shape), line(data, f"{name}, on idle cores", colour, "1:3", 4)]
    curves.append(f'x with lines dashtype 2 linewidth 1.2 linecolor rgb "{GREY}" title "ideal"')
    figure.panel("more threads", f"""set xrange [0.8:{top + 0.2}]; set yrange [0:{1.15 * top}]; set xtics 1
set xlabel "threads"; set ylabel "speed-up of a series"; set key bottom right Left reverse""", curves)
    figure.draw()


def psf_and_jitter(run, path):
    """Growth with the size of the PSF and with the steps of the jitter."""
    figure = Figure(path, 1500, 1150, 2, 2)
    gaussian = figure.data([(row["sigma px"], row["ms"]) for row in run.rows("BM_GrowthGaussian")])
    figure.panel("reference exposure, Gaussian PSF", """set xrange [0:3.2]; set yrange [0:*]
set xlabel "sigma, px"; set ylabel "ms an exposure"; unset key""", [points(gaussian, "", BLUE)])
    table = figure.data([(row["args"]["half-width"], row["ms"]) for row in run.rows("BM_GrowthTable")])
    figure.panel("reference exposure, PSF from a table", """set xrange [0:13]; set yrange [0:*]
set xlabel "half-width of the table, px"; set ylabel "ms an exposure"; unset key""", [points(table, "", BLUE)])
    for crowded, title in ((0, "reference: 5000 stars on 1024² px"), (1, "crowd: 32,240 stars on 480² px")):
        rows = {}
        for row in run.rows("BM_GrowthJitter", crowded=crowded):
            rows.setdefault(row["args"]["treatment"], []).append(row)
        shift, broadened = rows[1][0]["ms"], rows[2][0]["ms"]
        steps = figure.data([(row["args"]["amount"], row["ms"]) for row in rows[3]])
        terms = figure.data([(row["terms"], row["ms"]) for row in rows[4]])
        figure.panel(title, """set logscale xy; set xrange [0.9:120]; set yrange [1:500]
set xlabel "steps, or terms of the polynomial"; set ylabel "ms an exposure"; set key top left Left reverse
set xtics (1, 3, 10, 30, 100); set ytics (1, 3, 10, 30, 100, 300)""",
                     [points(steps, "every step", RED), points(terms, "polynomial", BLUE, 5),
                      f'{broadened} with lines dashtype 2 linecolor rgb "{PURPLE}" title "shift and broadening"',
                      f'{shift} with lines dashtype 3 linecolor rgb "{GREEN}" title "shift"'])
    figure.draw()


def kernels(run, path):
    """Nanoseconds a pixel by kernel and instruction set."""
    table = run.kernels()
    names = list(table)
    styles = {"AVX3": (BLUE, 7, "AVX-512"), "AVX2": (SKY, 5, "AVX2"), "SSE4": (ORANGE, 9, "SSE4"), "SSSE3": (RED, 11, "SSSE3"),
              "scalar": (GREY, 13, "plain scalar twin")}
    figure = Figure(path, 1500, 850)
    labels = ", ".join(f'"{name}" {len(names) - i}' for i, name in enumerate(names))
    curves = []
    for target, (colour, shape, title) in styles.items():
        rows = [(table[name][target], len(names) - i) for i, name in enumerate(names) if target in table[name]]
        if rows:
            curves.append(f'{figure.data(rows)} using 1:2 with points pointtype {shape} pointsize 2 linecolor rgb "{colour}" title "{title}"')
    figure.script += f"""set lmargin 24; set rmargin 21; set bmargin 4; set tmargin 1.5
set logscale x; set xrange [0.07:80]; set yrange [0.3:{len(names) + 0.7}]; set ytics ({labels}); unset title
set xtics ("0.1" 0.1, "0.2" 0.2, "0.5" 0.5, "1" 1, "2" 2, "5" 5, "10" 10, "20" 20, "50" 50)
set xlabel "ns a pixel, one core"; set key outside right center vertical Left reverse samplen 1
plot {", ".join(curves)}
"""
    figure.draw()


PARTS = (("stars", ("stars",), BLUE), ("photon noise", ("photon-noise",), ORANGE), ("readout noise", ("readout-noise",), SKY),
         ("ADC", ("adc",), GREEN), ("other pixel arithmetic", ("sky", "prnu", "dark-current", "gain", "bias", "full-well"), GREY),
         ("photometry", ("photometry",), PURPLE), ("light curves, statistics", ("writing",), RED), ("page, figures, checksums", ("page",), BLACK))


def where(run, path):
    """Where the time of an exposure and of the week goes, as stacked bars of shares."""
    bars = [(name, "ms", dict(run.effects(scene))) for name, scene in
            (("reference exposure", "reference"), ("with everything", "everything"), ("static", "static"))]
    if run.week:
        times = run.week["timings_seconds"]
        bars.append(("the week", "s of CPU", {**run.week["effects_cpu_seconds"], "photometry": times["measure_cpu"],
                                             "writing": times["statistics"] + times["light_curves"], "page": times["analyse"]}))
    figure = Figure(path, 1500, 560)
    boxes, labels = [], []
    for i, (name, unit, parts) in enumerate(bars):
        y = len(bars) - i
        total = sum(parts.values())
        labels.append(f'"{name}" {y}')
        left = 0.0
        for part, (_, keys, colour) in enumerate(PARTS):
            share = 100 * sum(parts.get(key, 0.0) for key in keys) / total
            boxes.append((left + share / 2, y, share / 2, 0.32, int(colour[1:], 16)))
            if share >= 6:
                value = share * total / 100
                figure.script += f'set label "{value:.2g}" at {left + share / 2},{y} center front textcolor rgb "{"#222222" if colour in (ORANGE, SKY, PURPLE) else "#ffffff"}"\n'
            left += share
        figure.script += f'set label "{total:.3g} {unit}" at 101,{y} left textcolor rgb "#222222"\n'
    data = figure.data(boxes)
    keys = [f'1/0 with boxes fillstyle solid 1 noborder linecolor rgb "{colour}" title "{title}"' for title, _, colour in PARTS]
    figure.script += f"""set lmargin 21; set rmargin 15; set bmargin 4; set tmargin 4.5; unset title; set grid noytics; set border 1
set xrange [0:100]; set yrange [0.4:{len(bars) + 0.6}]; set ytics ({", ".join(labels)}) scale 0; set style fill solid 1 noborder
set xlabel "% of its time"; set key outside top center horizontal Left reverse maxcols 4 samplen 1
plot {data} using 1:2:3:4:5 with boxxyerror linecolor rgb variable fillstyle solid 1 border rgb "#ffffff" notitle, {", ".join(keys)}
"""
    figure.draw()


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    run = Run(pathlib.Path(sys.argv[1]))
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else ROOT / "docs" / "figures"
    for name, draw in (("growth", growth), ("psf_jitter", psf_and_jitter), ("kernels", kernels), ("where", where)):
        path = folder / f"performance_{name}.png"
        draw(run, path)
        print(path)


if __name__ == "__main__":
    main()
