// Our FITS files as independent programs see them: astropy (its own reader, WCSLIB) and fitsverify.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/core/fits.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

// What a shell command prints, or nothing when it fails.
std::optional<std::string> output_of(const std::string& command) {
  std::FILE* pipe = popen(("(" + command + ") 2>&1").c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  return pclose(pipe) == 0 ? std::optional(text) : std::nullopt;
}

// A Python that has astropy: Debian's own when another one comes first in the path.
std::optional<std::string> python() {
  for (const char* name : {"python3", "/usr/bin/python3"}) {
    if (output_of(std::string(name) + " -c 'import astropy.io.fits, astropy.wcs'")) return name;
  }
  return std::nullopt;
}

CameraPointing pointing() {
  return {.axis = {359.9, 89.2}, .roll = Degrees(33.0), .scale = PixelScale(15.0), .axis_pixel = {2254.5, 100.25}};
}

// One file with everything that ASTROID writes.
std::filesystem::path write_example(const std::filesystem::path& folder) {
  auto path = folder / "example.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned16, {3, 2});
  writer.cards(SkyProjection(pointing()).fits_cards());
  writer.card({"GAIN", 1.0 / 3.0, "[e-/ADU] gain"});
  writer.card({"BUNIT", "adu"});
  writer.card({"LONGTEXT", std::string(200, 'x')});
  for (int i = 0; i < 60; ++i) writer.history("a line of the plan that makes the header longer than one block");
  writer.write_pixels(0, std::vector<std::uint16_t>{0, 1, 32767, 32768, 65534, 65535});
  writer.begin_image(FitsNumber::kFloat32, {2, 2, 2}, "CUBE");
  writer.write_pixels(0, std::vector<float>{0, 1, 2, 3, 4, 5, 6, std::nanf("")});
  writer.begin_large_image(FitsNumber::kFloat32, {5000, 3}, "FLUX");
  for (std::int64_t star = 0; star < 3; ++star) {
    writer.write_pixels(star * 5000 + 100, std::vector<float>(200, static_cast<float>(star + 1)));
  }
  writer.begin_table({{.name = "ID", .text_width = 6},
                      {.name = "MAG", .number = FitsNumber::kFloat64, .unit = "mag"},
                      {.name = "FLAGS", .number = FitsNumber::kInt32},
                      {.name = "SOURCE", .number = FitsNumber::kInt64}},
                     "STARS");
  writer.write_column(0, 0, std::vector<std::string>{"a", "bb", "cccccc"});
  writer.write_column(1, 0, std::vector<double>{0.1, std::nan(""), 3.0});
  writer.write_column(2, 0, std::vector<std::int32_t>{1, -2, 3});
  writer.write_column(3, 0, std::vector<std::int64_t>{5853498713190525696, 0, -1});
  writer.select(1);
  writer.card({"GAIN", 25.0, "[e-/ADU] gain, corrected"});
  writer.commit();
  return path;
}

TEST(FitsFiles, PassFitsverify) {
  if (!output_of("command -v fitsverify")) GTEST_SKIP() << "fitsverify is not installed";
  const test::TemporaryFolder folder;
  const auto report = output_of("fitsverify '" + write_example(folder.path()).string() + "' || true");
  ASSERT_TRUE(report);
  EXPECT_NE(report->find("found 0 warning(s) and 0 error(s)"), std::string::npos) << *report;
}

TEST(FitsFiles, AreReadByAstropyWithGoodChecksums) {
  const auto interpreter = python();
  if (!interpreter) GTEST_SKIP() << "python3-astropy is not installed";
  const test::TemporaryFolder folder;
  const auto path = write_example(folder.path());
  const auto script = folder.write("check.py", R"(
import sys, warnings
import numpy as np
from astropy.io import fits
warnings.simplefilter('error')
units = fits.open(sys.argv[1], checksum=True, memmap=False)
assert units[0].data.dtype == np.uint16
assert units[0].data.tolist() == [[0, 1, 32767], [32768, 65534, 65535]]
assert units[0].header['GAIN'] == 25.0
assert units[0].header['LONGTEXT'] == 'x' * 200
assert len(units[0].header['HISTORY']) == 60
assert 'CREATOR' not in units[0].header
for unit in units:
    assert 'CHECKSUM' in unit.header and 'DATASUM' in unit.header and 'DATE' in unit.header
assert units['CUBE'].data.shape == (2, 2, 2) and units['CUBE'].data[1, 1, 0] == 6 and np.isnan(units['CUBE'].data[1, 1, 1])
flux = units['FLUX'].data
assert flux.shape == (3, 5000) and flux[2, 100] == 3 and flux[2, 299] == 3 and flux[2, 300] == 0 and flux.sum() == 1200
stars = units['STARS'].data
assert list(stars['ID']) == ['a', 'bb', 'cccccc']
assert stars['MAG'][0] == 0.1 and np.isnan(stars['MAG'][1]) and stars['FLAGS'][1] == -2
assert stars['SOURCE'][0] == 5853498713190525696
assert units['STARS'].columns['MAG'].unit == 'mag'
units.close()
print('good')
)");
  std::string command = *interpreter + " '" + script.string() + "' '" + path.string() + "'";
  const auto output = output_of(command + " || true");
  EXPECT_EQ(output, "good\n");
}

TEST(FitsFiles, GiveAstropyOurPixelPositions) {
  const auto interpreter = python();
  if (!interpreter) GTEST_SKIP() << "python3-astropy is not installed";
  const test::TemporaryFolder folder;
  const auto path = write_example(folder.path());
  const auto script = folder.write("pixels.py", R"(
import sys, warnings
from astropy.io import fits
from astropy.wcs import WCS
warnings.simplefilter('ignore')
wcs = WCS(fits.getheader(sys.argv[1]))
for line in open(sys.argv[2]):
    ra, dec = map(float, line.split())
    print(*map(repr, map(float, wcs.all_world2pix(ra, dec, 0))))
)");
  const SkyProjection projection(pointing());
  std::vector<SkyPosition> stars;
  std::string list;
  for (int i = 0; i <= 10; ++i) {
    for (int k = 0; k <= 10; ++k) {
      const double x = 450.0 * i;
      const double y = 450.0 * k;
      stars.push_back(projection.to_sky({x, y}));
      char line[80];
      std::snprintf(line, sizeof line, "%.17g %.17g\n", stars.back().ra, stars.back().dec);
      list += line;
    }
  }
  const auto output = output_of(*interpreter + " '" + script.string() + "' '" + path.string() + "' '" +
                                folder.write("stars.txt", list).string() + "'");
  ASSERT_TRUE(output);
  std::istringstream lines(*output);
  for (const SkyPosition& star : stars) {
    double x = 0.0;
    double y = 0.0;
    ASSERT_TRUE(lines >> x >> y) << *output;
    const auto pixel = projection.to_pixel(star);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, x, 1e-6);
    EXPECT_NEAR(pixel->y, y, 1e-6);
  }
}

// Real headers: SIP distortions (FK5 and ICRS), CAR in galactic coordinates, plain TAN with CDELT and with CD.
TEST(SkyProjection, AgreesWithAstropyOnRealHeaders) {
  const auto interpreter = python();
  if (!interpreter) GTEST_SKIP() << "python3-astropy is not installed";
  if (!test::shared_data("images")) GTEST_SKIP() << "no shared data";
  const test::TemporaryFolder folder;
  const auto script = folder.write("pixels.py", R"(
import sys, warnings
from astropy.io import fits
from astropy.wcs import WCS
from astropy.coordinates import SkyCoord
import astropy.units as u
warnings.simplefilter('ignore')
header = fits.getheader(sys.argv[1], int(sys.argv[2]) - 1)
wcs = WCS(header)
for x in range(0, 90, 11):
    for y in range(0, 90, 11):
        a, b = map(float, wcs.all_pix2world(x, y, 0))
        if header['CTYPE1'].startswith('GLON'):
            c = SkyCoord(a * u.deg, b * u.deg, frame='galactic').icrs
            a, b = float(c.ra.deg), float(c.dec.deg)
        print(x, y, repr(a), repr(b))
)");
  struct Case {
    const char* file;
    int unit;
    double tolerance;  // px
  };
  // Galactic: we take the pole in ICRS as the Hipparcos catalogue defines it, astropy the same numbers in FK5; the two
  // systems are 23 mas apart, 0.02 px of this image.
  for (const Case& c : {Case{"kepler_ffi_ch01_cutout.fits", 2, 1e-6}, Case{"stellarphot_wcs_ey_uma.fits", 1, 1e-6},
                        Case{"stellarphot_cutout_fwhm.fits", 1, 1e-6}, Case{"gc_2mass_h.fits", 1, 1e-6},
                        Case{"dss_horsehead.fits", 1, 1e-6}, Case{"spitzer_example_image.fits", 1, 0.021}}) {
    const auto path = test::shared_data(std::string("images/") + c.file);
    ASSERT_TRUE(path) << c.file;
    const FitsReader reader(*path);
    const auto projection = SkyProjection::from_header(reader.header_text(c.unit), c.file);
    ASSERT_TRUE(projection) << c.file;
    const auto output =
        output_of(*interpreter + " '" + script.string() + "' '" + path->string() + "' " + std::to_string(c.unit));
    ASSERT_TRUE(output) << c.file;
    std::istringstream lines(*output);
    double x = 0.0;
    double y = 0.0;
    SkyPosition star;
    int count = 0;
    while (lines >> x >> y >> star.ra >> star.dec) {
      ++count;
      const auto pixel = projection->to_pixel(star);
      ASSERT_TRUE(pixel) << c.file;
      EXPECT_NEAR(pixel->x, x, c.tolerance) << c.file;
      EXPECT_NEAR(pixel->y, y, c.tolerance) << c.file;
      EXPECT_LT(angular_separation(projection->to_sky({x, y}), star).value() * 3600.0,
                c.tolerance * projection->pixel_scale().value())
          << c.file;
      EXPECT_TRUE(projection->attitude_jacobian(star)) << c.file;
    }
    EXPECT_EQ(count, 81) << c.file << *output;
  }
}

}  // namespace
}  // namespace astroid
