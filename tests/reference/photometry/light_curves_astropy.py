"""Reads light curves as others do: python3 light_curves_astropy.py lightcurves.fits single.fits

Prints every number the test compares, one line a quantity; checks of layout are assertions.
"""
import sys

import numpy as np
from astropy.io import fits
from astropy.table import Table
from astropy.time import Time

with fits.open(sys.argv[1], checksum=True) as hdus:
    for hdu in hdus:
        assert hdu.verify_checksum() == 1 and hdu.verify_datasum() == 1, hdu.name
    assert [hdu.name for hdu in hdus[1:]] == ["TIME", "STARS", "CAMERA1", "CAMERA2", "COMBINED", "FLAGS"]
    cube = hdus["COMBINED"].data
    assert cube.dtype == np.dtype(">f4") and cube.shape == (hdus[0].header["STARS"], hdus[0].header["EXPOSURE"])
    assert hdus["TIME"].header["TIMESYS"] == "TDB" and hdus["TIME"].header["BJDREFI"] == 2457000
    print(*map(repr, hdus["TIME"].data["TIME"].tolist()))
    print(*map(repr, hdus["STARS"].data["REFERENCE"].tolist()))
    print(*map(repr, hdus["CAMERA2"].section[1, :].tolist()))
    print(*map(repr, cube[1].tolist()))
    print(*hdus["FLAGS"].data["FLAGS"].tolist())

# The rules of lightkurve's generic reader (lightkurve.io.generic, version 2.6).
with fits.open(sys.argv[2]) as hdus:
    for header in (hdus[0].header, hdus[1].header):
        assert "CREATOR" not in header and "ORIGIN" not in header
        assert header["TELESCOP"] == "ASTROID" and header["TIMESYS"] == "TDB" and header["TIMEUNIT"] == "d"
        assert header["BJDREFI"] == 2457000 and header["BJDREFF"] == 0
    table = Table.read(hdus[1], format="fits")
    assert table.colnames[:5] == ["TIME", "FLUX", "FLUX_ERR", "QUALITY", "CADENCENO"]
    assert str(table["FLUX"].unit) == "electron"
    time = Time(np.asarray(table["TIME"]) + 2457000, scale=hdus[1].header["TIMESYS"].lower(), format="jd")
    print(repr(float(time[0].mjd)))
    print(*map(repr, table["FLUX"].tolist()))
    print(*map(repr, table["FLUX_ERR"].tolist()))
