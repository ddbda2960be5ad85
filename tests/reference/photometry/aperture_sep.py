"""Exact circular aperture sums by sep (subpix=0) of a raw float64 image: python3 aperture_sep.py image nx ny apertures.

apertures: text lines "x y radius"; prints one sum a line.
"""
import sys

import numpy as np
import sep

image = np.fromfile(sys.argv[1]).reshape(int(sys.argv[3]), int(sys.argv[2]))
for x, y, radius in np.loadtxt(sys.argv[4]):
    total, _, _ = sep.sum_circle(image, [x], [y], [radius], subpix=0)
    print(repr(float(total[0])))
