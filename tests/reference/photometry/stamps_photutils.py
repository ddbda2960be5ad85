"""Stamps of 15 x 15 px by photutils: python3 stamps_photutils.py cases; prints 225 pixels, row by row, one a line, for each.

cases: text lines "kind x y size slope", pixels of the stamp counted from 0.
gaussian: IntegratedGaussianPRF of sigma = size. moffat: PRFAdapter, which integrates astropy's profile over each pixel by
adaptive quadrature; alpha = size, beta = slope. circle: share of each pixel in an aperture of radius size, method exact.
"""
import sys

import numpy as np
from astropy.modeling.functional_models import Moffat2D
from photutils.aperture import CircularAperture
from photutils.psf import IntegratedGaussianPRF, PRFAdapter

SIDE = 15
rows, columns = np.mgrid[:SIDE, :SIDE]


def stamp(kind, x, y, size, slope):
    if kind == "gaussian":
        return IntegratedGaussianPRF(sigma=size, flux=1.0, x_0=x, y_0=y)(columns, rows)
    if kind == "moffat":
        profile = Moffat2D(amplitude=(slope - 1) / (np.pi * size**2), x_0=0, y_0=0, gamma=size, alpha=slope)
        # Moved by the adapter: photutils 1.6 swaps x and y of a profile that it moves by the names of its centre.
        return PRFAdapter(profile, renormalize_psf=False, flux=1.0, x_0=x, y_0=y)(columns, rows)
    return CircularAperture((x, y), size).to_mask(method="exact").to_image((SIDE, SIDE))


with open(sys.argv[1], encoding="ascii") as file:
    for line in file:
        kind, x, y, size, slope = line.split()
        for value in np.ravel(stamp(kind, float(x), float(y), float(size), float(slope))):
            print(repr(float(value)))
