#!/usr/bin/python3
"""Detection and aperture photometry of the same images by astroid, sep and source-extractor, one after the other on one core.

usage: peers.py ASTROID [--runs N] [--images FOLDER] [--cpu N] [--update docs/performance.md]
Prints a table of medians; with --update it goes between the marks "table: peers" of that file.
Needs python3-numpy, python3-scipy, python3-astropy, python3-sep and source-extractor (its column is left out where that is not installed).

Images are fields of Gaussian stars on 1024² px: sky 20 e-, read noise 5 e-, magnitudes 12.5 to 20.5 (25 is one electron), as in
tests/support/star_field.cpp. All find stars and sum circles of 3 px over a mesh of 64 px:
  sep              Background, subtraction, extract at 1.5 sigma with its default filter, sum_circle; in memory, import and reading not counted
  source-extractor the whole command, catalogue written
  astroid measures background, detection and fluxes, in memory; and astroid command, the whole of it with start, reading and writing
Fluxes are compared star by star: stars that both found within half a pixel, at sep's own positions."""
import argparse, csv, json, os, pathlib, platform, shutil, statistics, subprocess, tempfile, time

import numpy as np
import sep
from astropy.io import fits
from scipy.spatial import cKDTree
from scipy.special import erf

SKY, READ_NOISE, SIZE, RADIUS = 20.0, 5.0, 1024, 3.0
FIELDS = {  # stars, FWHM px, slope of counts
    "sparse": (1500, 2.5, 0.10),
    "crowded": (15000, 2.5, 0.25),
    "undersampled": (3000, 1.3, 0.15),
}
SEXTRACTOR_COLUMNS = ("X_IMAGE", "Y_IMAGE", "FLUX_APER(1)", "FLUXERR_APER(1)", "FLAGS")
SEXTRACTOR_FILTER = "CONV NORM\n1 2 1\n2 4 2\n1 2 1\n"


def make_image(path, stars, fwhm, slope, seed):
    rng = np.random.default_rng(seed)
    sigma = fwhm / 2.3548200450309493
    low, high = 10 ** (slope * 12.5), 10 ** (slope * 20.5)
    mag = np.log10(low + rng.random(stars) * (high - low)) / slope
    flux, x, y = 10 ** (0.4 * (25 - mag)), rng.random(stars) * SIZE - 0.5, rng.random(stars) * SIZE - 0.5
    light = np.full((SIZE, SIZE), SKY)
    scale, reach = 1 / (np.sqrt(2) * sigma), int(np.ceil(9 * sigma))
    for u, v, f in zip(x, y, flux):
        columns, rows = (np.arange(max(0, round(w) - reach), min(SIZE, round(w) + reach + 1)) for w in (u, v))
        p, q = (0.5 * (erf((i + 0.5 - w) * scale) - erf((i - 0.5 - w) * scale)) for i, w in ((columns, u), (rows, v)))
        light[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1] += f * np.outer(q, p)
    image = rng.poisson(light) + rng.normal(0, READ_NOISE, light.shape)
    header = fits.Header([("GAIN", 1.0), ("RDNOISE", READ_NOISE), ("EXPTIME", 1.0)])
    fits.writeto(path, image.astype(np.float32), header, overwrite=True)


def run_sep(image):
    start = time.perf_counter()
    background = sep.Background(image)
    clean = image - background
    found = sep.extract(clean, 1.5, err=background.globalrms)
    flux, _, _ = sep.sum_circle(clean, found["x"], found["y"], RADIUS, err=background.globalrms, gain=1.0)
    return time.perf_counter() - start, found["x"], found["y"], flux, clean


def run_command(command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def sextractor(name, folder):
    (folder / "peers.param").write_text("\n".join(SEXTRACTOR_COLUMNS) + "\n")
    (folder / "peers.conv").write_text(SEXTRACTOR_FILTER)
    (folder / "peers.sex").write_text("")
    return ["source-extractor", f"{name}.fits", "-c", "peers.sex", "-PARAMETERS_NAME", "peers.param", "-FILTER_NAME", "peers.conv",
            "-CATALOG_NAME", f"{name}.cat", "-PHOT_APERTURES", str(2 * RADIUS), "-GAIN_KEY", "GAIN", "-VERBOSE_TYPE", "QUIET",
            "-BACK_SIZE", "64", "-NTHREADS", "1", "-MEMORY_PIXSTACK", "3000000"]


def compare_fluxes(table, image, clean):
    """Median and robust scatter of astroid's flux less sep's in the same circle, in units of astroid's error."""
    rows = list(csv.DictReader(open(table)))
    x, y, flux, error = (np.array([float(r[k]) for r in rows]) for k in ("x", "y", "flux", "flux_err"))
    flags = np.array([int(r["flags"]) for r in rows])
    theirs, _, _ = sep.sum_circle(clean, x, y, RADIUS, subpix=0)
    pull = ((flux - theirs) / error)[flags == 0]
    return np.median(pull), 1.4826 * np.median(np.abs(pull - np.median(pull)))


def measure(astroid, name, folder, runs):
    image = fits.getdata(folder / f"{name}.fits").astype(np.float32)
    ours = [astroid, "photometry", f"{name}.fits", "--method", "aperture", "--radius", str(RADIUS), "-o", f"{name}.csv", "--overwrite"]
    have_sextractor = shutil.which("source-extractor") is not None
    times = {"sep": [], "source-extractor": [], "astroid measures": [], "astroid command": []}
    for _ in range(runs):  # in turn, so that a busy moment of the machine meets all of them
        seconds, x, y, flux, clean = run_sep(image)
        times["sep"].append(seconds)
        if have_sextractor:
            times["source-extractor"].append(run_command(sextractor(name, folder), folder))
        times["astroid command"].append(run_command(ours, folder))
        record = json.loads((folder / f"{name}.csv.json").read_text())
        times["astroid measures"].append(record["seconds"]["measuring"])
    bias, scatter = compare_fluxes(folder / f"{name}.csv", image, clean)
    stars = {"sep": len(x), "astroid": record["sources"]}
    if have_sextractor:
        stars["source-extractor"] = sum(not line.startswith("#") for line in open(folder / f"{name}.cat"))
    return {k: statistics.median(v) for k, v in times.items() if v}, stars, (bias, scatter)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("astroid")
    parser.add_argument("--runs", type=int, default=11)
    parser.add_argument("--images", help="folder to keep the images in")
    parser.add_argument("--cpu", type=int, default=0, help="the core to run on")
    parser.add_argument("--update", help="file whose table is replaced")
    options = parser.parse_args()
    os.sched_setaffinity(0, {options.cpu})
    os.environ["OMP_NUM_THREADS"] = "1"
    sep.set_extract_pixstack(3000000)
    astroid = str(pathlib.Path(options.astroid).resolve())
    lines = ["|  | stars of sep | of astroid | sep, ms | source-extractor, ms | astroid measures, ms | astroid command, ms | flux − sep's, of its error |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(options.images or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for seed, (name, field) in enumerate(FIELDS.items(), 1):
            make_image(folder / f"{name}.fits", *field, seed)
            seconds, stars, (bias, scatter) = measure(astroid, name, folder, options.runs)
            ms = {k: f"{1e3 * v:.0f}" for k, v in seconds.items()}
            lines.append(f"| {name} | {stars['sep']} | {stars['astroid']} | {ms['sep']} | {ms.get('source-extractor', '–')} | "
                         f"{ms['astroid measures']} | {ms['astroid command']} | {bias:+.3f} ± {scatter:.3f} |")
    table = "\n".join(lines)
    print(table)
    print(f"\n{time.strftime('%Y-%m-%d %H:%M', time.gmtime())} UTC, {platform.processor() or platform.machine()}, load {os.getloadavg()[0]:.1f}")
    if options.update:
        text = pathlib.Path(options.update).read_text()
        begin = text.index("<!-- table: peers -->") + len("<!-- table: peers -->")
        end = text.index("<!-- end -->", begin)
        pathlib.Path(options.update).write_text(text[:begin] + "\n" + table + "\n" + text[end:])


if __name__ == "__main__":
    main()
