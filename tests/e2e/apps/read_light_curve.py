"""Opens an exported light curve as lightkurve does, and compares it with the file of all. Arguments: file, file of all, star."""
import sys

import numpy
from astropy.io import fits
from astropy.table import Table
from astropy.time import Time

single, everything, star = sys.argv[1:]
with fits.open(single) as file:
    assert file[1].name == "LIGHTCURVE", file[1].name
    header = file[1].header
    table = Table.read(file[1], format="fits")
    for name in ("TIME", "FLUX", "FLUX_ERR", "QUALITY"):
        assert name in [c.upper() for c in table.colnames], (name, table.colnames)
    reference = header["BJDREFI"] + header["BJDREFF"]
    time = Time(table["TIME"] + reference, format="jd", scale="tdb")
    flux = numpy.array(table["FLUX"])
# Mid-exposure of the first: half of 21 s after the start; then every 25 s.
assert abs((time[0] - Time("2027-01-01T00:00:10.5", scale="tdb")).sec) < 1e-3, time[0].isot
assert numpy.allclose(numpy.diff(time.jd) * 86400, 25, atol=1e-3)
with fits.open(everything) as file:
    row = [name.strip() for name in file["STARS"].data["ID"]].index(star)
    expected = file["STARS"].data["REFERENCE"][row] * (1 + file["CAMERA1"].data[row].astype(float))
assert numpy.allclose(flux, expected, rtol=2e-7), (flux, expected)
print("all is well")
