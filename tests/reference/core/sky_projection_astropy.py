"""Sky positions of pixels (0-based) by astropy, distortion included: python3 sky_projection_astropy.py header pixels.

header: cards of 80 characters, one a line; pixels: text lines "x y"; prints "ra dec x y" a line: the direction, and the
pixel that astropy finds for it again.
"""
import sys
import warnings

import numpy as np
from astropy.io import fits
from astropy.wcs import WCS

warnings.simplefilter("ignore")
with open(sys.argv[1], encoding="ascii") as file:
    header = fits.Header.fromstring(file.read(), sep="\n")
wcs = WCS(header)
pixels = np.loadtxt(sys.argv[2], ndmin=2)
sky = wcs.all_pix2world(pixels, 0)
back = wcs.all_world2pix(sky, 0, tolerance=1e-9, maxiter=100)
for (ra, dec), (x, y) in zip(sky, back):
    print(repr(float(ra)), repr(float(dec)), repr(float(x)), repr(float(y)))
