"""Reads the images and light curves of a run with astropy and compares them with its tables. Argument: the folder."""
import csv
import pathlib
import sys

import numpy
from astropy.io import fits
from astropy.wcs import WCS

folder = pathlib.Path(sys.argv[1])
truth = list(csv.DictReader(open(folder / "truth/stars.csv")))
path = folder / "images/camera1_000000.fits"

with fits.open(path, checksum=True) as image:
    header = image[0].header
    assert image[0].data.shape == (95, 90), image[0].data.shape
    wcs = WCS(header)
    ra, dec, x, y = (numpy.array([float(star[k]) for star in truth]) for k in ("ra", "dec", "x", "y"))
    px, py = wcs.all_world2pix(ra, dec, 0)
    # Images are cut at column 5, row 3 of the detector, where the positions of the truth count from.
    assert header["LTV1"] == -5 and header["LTV2"] == -3
    # Truth is given to 9 decimals of a degree at worst: 2e-7 px.
    worst = numpy.abs(numpy.concatenate([px - header["LTV1"] - x, py - header["LTV2"] - y])).max()
    assert worst < 1e-6, worst
    for key in ("BUNIT", "GAIN", "RDNOISE", "EXPTIME", "DATE-OBS", "SATURATE", "CHECKSUM", "DATASUM", "RADESYS"):
        assert key in header, key
    assert header["GAIN"] == 25 and header["EXPTIME"] == 21 and header["RDNOISE"] == 50.2
    assert any("readout-noise" in line for line in header["HISTORY"]), "the plan belongs into HISTORY"
    assert image[0].data.dtype == numpy.uint16, image[0].data.dtype
    assert abs(numpy.median(image[0].data.astype(float)) - 1000 - 970.2 / 25) < 3
with fits.open(path, do_not_scale_image_data=True) as image:
    assert image[0].header["BITPIX"] == 16 and image[0].header["BZERO"] == 32768

sources = {row["id"]: row for row in csv.DictReader(open(folder / "photometry/sources.csv"))}
with fits.open(folder / "photometry/lightcurves.fits", checksum=True) as curves:
    stars = curves["STARS"].data
    flux = curves["CAMERA1"].data
    assert flux.shape == (len(stars), 6) and flux.dtype.newbyteorder("=") == numpy.float32
    assert len(sources) == len(stars)
    for star, series in zip(stars, flux):
        mean = star["REFERENCE"] * (1 + series.astype(float).mean())
        assert abs(mean / float(sources[star["ID"].strip()]["flux"]) - 1) < 1e-6, star["ID"]
print("all is well")
