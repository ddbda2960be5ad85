// A real field of the galactic plane (Gaia DR3, 24,000 stars per square degree), imaged and recovered blindly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/core/statistics/robust.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kSide = 1000;

// 50 s of a telescope with pixels of 2 arcsec; stars down to G 18.5 have 8000 e- or more.
Mission mission() {
  Mission m = test::bare_mission(kSide, kSide);
  m.simulation.start_mjd = 57388.0;  // J2016.0, the catalogue's epoch
  m.simulation.exposure_time = Seconds(50.0);
  m.satellite.ra = Degrees(6.305);
  m.satellite.dec = Degrees(61.325);
  m.telescope.zero_point = Magnitude(24.0);
  m.field.catalogue_epoch = 2016.0;
  m.field.sky_background = ElectronsPerSecond(2.0);
  m.psf.sigma = Pixels(1.0);
  m.ccd.pixel_scale = PixelScale(2.0);
  m.ccd.readout_noise = Electrons(5.0);
  m.ccd.gain = Gain(5.0);
  m.ccd.bias = Adu(200.0);
  m.ccd.full_well = Electrons(1e6);
  m.ccd.adc_bits = 18;
  return m;
}

/// Whether pixels near a place are full or received what others spilt.
bool is_spoilt(const Frame& frame, PixelPosition p) {
  constexpr int kNear = 5;  // px
  const auto flags = frame.flags.view(0);
  const int x0 = static_cast<int>(std::lround(p.x));
  const int y0 = static_cast<int>(std::lround(p.y));
  for (int y = std::max(0, y0 - kNear); y <= std::min(kSide - 1, y0 + kNear); ++y)
    for (int x = std::max(0, x0 - kNear); x <= std::min(kSide - 1, x0 + kNear); ++x)
      if (flags.at(x, y) != 0) return true;
  return false;
}

TEST(GaiaPlane, IsRecoveredFromItsImage) {
  const auto list = test::shared_data("catalogues/gaiadr3_plane_G18.5.csv");
  if (!list) GTEST_SKIP() << "the shared catalogues are not here";
  CatalogueOptions options;
  options.passband = "G";
  const auto scene = std::make_shared<const Scene>(mission(), read_catalogue(*list, options));
  const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  Frame& frame = state.frame;
  frame.header.gain = scene->mission().ccd.gain;
  frame.header.bias = scene->mission().ccd.bias;
  frame.header.readout_noise = scene->mission().ccd.readout_noise;
  const auto sources = measure_field(frame, nullptr, *make_gaussian_psf(1.0), {});

  int possible = 0;
  int found = 0;
  std::vector<double> pull;
  std::vector<double> error;
  for (const SceneStar& star : scene->stars()) {
    constexpr double kCut = 8.0;  // px
    if (std::min(star.position.x, star.position.y) < kCut || std::max(star.position.x, star.position.y) > kSide - kCut)
      continue;
    if (is_spoilt(frame, star.position)) continue;
    // What one star with another within 0.7 FWHM looks like: one star.
    constexpr double kResolvable = 1.65;  // px
    const bool blended = std::ranges::any_of(scene->stars(), [&](const SceneStar& other) {
      return &other != &star &&
             std::hypot(other.position.x - star.position.x, other.position.y - star.position.y) < kResolvable;
    });
    if (blended) continue;
    ++possible;
    const auto match = std::ranges::min_element(sources, {}, [&](const SourceMeasurement& s) {
      return std::hypot(s.x - star.position.x, s.y - star.position.y);
    });
    if (std::hypot(match->x - star.position.x, match->y - star.position.y) > 1.0) continue;
    ++found;
    pull.push_back((match->flux - star.electrons) / match->flux_err);
    error.push_back(match->flux / star.electrons - 1.0);
  }
  const double width = robust_spread(pull).value;
  std::cout << found << " of " << possible << " stars, bias " << 1e2 * quantile(error, 0.5).value << " %, pulls "
            << width << '\n';
  EXPECT_GT(possible, 5500);
  EXPECT_GE(found, 0.998 * possible);
  EXPECT_LE(std::abs(quantile(error, 0.5).value), 0.002);
  EXPECT_NEAR(width, 1.0, 0.1);
}

}  // namespace
}  // namespace astroid
