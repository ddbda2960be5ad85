// Distorted sky coordinates against those that astropy makes of our FITS headers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/core/csv.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/test/plato_distortion.hpp"
#include "astroid/test/python.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kSide = 4510;  // px

CameraPointing corner_camera(double roll, std::shared_ptr<const Distortion> distortion) {
  return {.axis = {95.3104, -47.8869},
          .roll = Degrees(roll),
          .scale = PixelScale(15.0),
          .axis_pixel = {-82.5, -60.25},
          .projection = "TAN",
          .distortion = std::move(distortion),
          .detector = {0, 0, kSide, kSide}};
}

std::string header_text(const SkyProjection& projection, int x0, int y0) {
  std::string text;
  const auto add = [&text](std::string card) {
    card.resize(80, ' ');
    text += card + "\n";
  };
  for (const std::string card :
       {"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    2",
        "NAXIS1  =                  100", "NAXIS2  =                  100"})
    add(card);
  for (const FitsCard& card : projection.fits_cards(x0, y0)) {
    std::string value;
    if (const auto* word = std::get_if<std::string>(&card.value)) value = fmt::format("'{}'", *word);
    if (const auto* number = std::get_if<double>(&card.value)) value = shortest_text(*number);
    if (const auto* number = std::get_if<std::int64_t>(&card.value)) value = std::to_string(*number);
    add(fmt::format("{:<8}= {}", card.key, value));
  }
  add("END");
  return text;
}

struct Differences {
  double sky = 0.0;    // px: of the direction of a pixel
  double pixel = 0.0;  // px: of the pixel of that direction
};

/// Largest differences over the detector.
Differences differences(const SkyProjection& projection) {
  constexpr int kFirst = 1000;  // of a sub-field, whose header must say the same
  const test::TemporaryFolder folder;
  const auto header = folder.write("header.txt", header_text(projection, kFirst, kFirst));
  std::vector<PixelPosition> pixels;
  std::ostringstream lines;
  lines.precision(17);
  for (int j = 0; j <= 10; ++j) {
    for (int i = 0; i <= 10; ++i) {
      pixels.push_back({450.95 * i, 450.85 * j});
      lines << pixels.back().x - kFirst << ' ' << pixels.back().y - kFirst << '\n';
    }
  }
  const auto list = folder.write("pixels.txt", lines.str());
  std::istringstream printed(test::run_python(test::source_dir() / "tests/reference/core/sky_projection_astropy.py",
                                              {header.string(), list.string()}));
  Differences worst;
  for (const PixelPosition& pixel : pixels) {
    SkyPosition sky;
    PixelPosition again;
    EXPECT_TRUE(printed >> sky.ra >> sky.dec >> again.x >> again.y);
    const double scale = projection.pixel_scale().value() / 3600.0;  // deg/px
    worst.sky = std::max(worst.sky, angular_separation(projection.to_sky(pixel), sky).value() / scale);
    const auto ours = projection.to_pixel(sky);
    EXPECT_TRUE(ours);
    if (ours) worst.pixel = std::max(worst.pixel, std::hypot(ours->x - kFirst - again.x, ours->y - kFirst - again.y));
  }
  return worst;
}

TEST(SkyProjection, WithSipHasAstropysCoordinates) {
  if (!test::python_has({"numpy", "astropy"})) GTEST_SKIP() << "python3-astropy is not installed";
  SipPolynomial sip(4);
  for (int i = 0; i <= sip.order; ++i) {
    for (int j = 0; i + j <= sip.order; ++j) {
      if (i + j < 2) continue;
      sip.a[sip.index(i, j)] = 20.0 * std::cos(3.0 * i + 5.0 * j) / std::pow(4500.0, i + j);
      sip.b[sip.index(i, j)] = 20.0 * std::sin(2.0 * i + 7.0 * j) / std::pow(4500.0, i + j);
    }
  }
  for (const double roll : {0.0, 37.0}) {
    const Differences d = differences(SkyProjection(corner_camera(roll, make_sip_distortion(sip))));
    EXPECT_LT(d.sky, 1e-8);
    EXPECT_LT(d.pixel, 1.1 * kPixelGrid);  // our positions are rounded to it
  }
}

TEST(SkyProjection, WithRadialDistortionWritesASipHeaderThatAstropyFollows) {
  if (!test::python_has({"numpy", "astropy"})) GTEST_SKIP() << "python3-astropy is not installed";
  const auto distortion = make_radial_distortion(test::plato_distortion(), test::plato_focal_length());
  const Differences d = differences(SkyProjection(corner_camera(-20.0, distortion)));
  std::cout << "largest differences: " << d.sky << " px of directions, " << d.pixel << " px of pixels\n";
  EXPECT_LT(d.sky, kHeaderTolerance);
  EXPECT_LT(d.pixel, 1.5 * kHeaderTolerance);
}

}  // namespace
}  // namespace astroid
