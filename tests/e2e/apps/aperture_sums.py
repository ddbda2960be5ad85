"""Compares aperture fluxes with those of sep, a library with SExtractor's sums. Arguments: image, sources.csv, radius."""
import csv
import sys

import numpy
import sep
from astropy.io import fits

image, table, radius = sys.argv[1], sys.argv[2], float(sys.argv[3])
with fits.open(image) as file:
    gain = file[0].header["GAIN"]
    pixels = numpy.ascontiguousarray(file[0].data.astype(float))
rows = list(csv.DictReader(open(table)))
assert len(rows) == 25
x, y, flux = (numpy.array([float(row[k]) for row in rows]) for k in ("x", "y", "flux"))
# subpix = 0: overlaps of pixels and circle in closed form, as ours.
sums, _, flags = sep.sum_circle(pixels, x, y, radius, subpix=0)
assert not flags.any(), flags
worst = numpy.abs(flux / (gain * sums) - 1).max()
assert worst < 1e-5, worst
print("all is well")
