// A corner of a real full-frame image of Kepler: its coordinates, against Tycho-2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "astroid/core/csv.hpp"
#include "astroid/photometry/detection.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

TEST(DetectStars, FindsTychoStarsAtTheirPlacesInAKeplerFrame) {
  const auto image = test::shared_data("images/kepler_ffi_ch01_cutout.fits");
  const auto list = test::shared_data("catalogues/tycho2_kepler_field_7deg.csv");
  if (!image || !list) GTEST_SKIP() << "the shared images are not here";
  const ImageFile file = read_frame(*image);
  ASSERT_TRUE(file.sky.has_value()) << "TAN-SIP";
  // e-/s, so the exposure time is the gain: 270 frames of 6.02 s.
  EXPECT_NEAR(file.frame.header.gain.value(), file.frame.header.exposure_time.value(), 1e-9);
  const Detection found = detect_stars(file.frame, BackgroundMap(file.frame, 0, {}), {});
  EXPECT_TRUE(found.fwhm_measured);
  EXPECT_GT(found.stars.size(), 100U);
  const CsvTable table = read_csv(*list);
  const Rectangle area = file.frame.pixels.layout().regions()[0];
  // Twelve columns of overscan and twenty masked rows have no stars.
  constexpr int kMasked = 20;
  std::vector<SourceRequest> requests;
  std::vector<double> magnitude;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const SkyPosition sky{*table.number(i, *table.column("ra")), *table.number(i, *table.column("dec"))};
    const auto place = file.sky->to_pixel(sky);
    if (!place || place->x < kMasked || place->y < kMasked || place->x > area.nx - 3.0 || place->y > area.ny - 3.0)
      continue;
    requests.push_back({std::to_string(i), std::nullopt, sky});
    magnitude.push_back(*table.number(i, *table.column("mag")));
    double nearest = 1e9;
    for (const DetectedStar& star : found.stars)
      nearest = std::min(nearest, std::hypot(star.x - place->x, star.y - place->y));
    std::cout << "V_T " << magnitude.back() << " at " << place->x << ", " << place->y << ": found " << nearest
              << " px beside\n";
    // Tycho-2 is good to 0.1 px of 4 arcsec with its proper motions left out, the WCS of a cut-out to a few tenths.
    EXPECT_LT(nearest, 0.5);
  }
  ASSERT_EQ(requests.size(), 2U);
  ImagePhotometrySettings settings;
  settings.aperture_radius = Pixels(3.0);
  const auto measured = measure_image(file.frame, &*file.sky, requests, settings);
  for (const SourceMeasurement& source : measured) {
    EXPECT_EQ(source.flags, 0U);
    EXPECT_GT(source.snr, 10.0);
  }
  // Their colours differ, and so do V_T and Kepler's band: half a magnitude is what that can do.
  const double fainter = -2.5 * std::log10(measured[1].flux / measured[0].flux);
  EXPECT_NEAR(fainter, magnitude[1] - magnitude[0], 1.0);
}

}  // namespace
}  // namespace astroid
