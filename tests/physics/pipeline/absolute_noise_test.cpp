// Absolute noise: isolated, pixel-centred stars measured with their optimal masks have the noise of SCIENCE 3.2.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr double kZeroPoint = 20.62;
constexpr double kExposure = 21.0;  // s
constexpr double kExposuresPerHour = 144.0;
constexpr double kCameras = 24.0;

/// Electrons per exposure of a star of magnitude P.
double electrons(double magnitude) {
  return std::pow(10.0, -0.4 * (magnitude - kZeroPoint)) * kExposure;
}

/// 400 stars of each magnitude on a grid of 40 px, each in the centre of a pixel.
std::vector<test::LabStar> grid(const std::vector<double>& magnitudes) {
  std::vector<test::LabStar> stars;
  for (const double magnitude : magnitudes)
    for (int i = 0; i < 400; ++i) {
      const auto n = static_cast<int>(stars.size());
      stars.push_back({20.0 + 40.0 * (n % 35), 20.0 + 40.0 * (n / 35), electrons(magnitude)});
    }
  return stars;
}

TEST(AbsoluteNoise, OfIsolatedStarsIsThatOfTheFormula) {
  Mission mission = test::bare_mission(1420, 1420);
  mission.simulation.exposures = 100 * static_cast<std::int64_t>(kExposuresPerHour);
  mission.telescope.cameras = static_cast<int>(kCameras);
  mission.psf.sigma = Pixels(0.6);
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(7.2 * std::sqrt(12.0));  // quantisation noise of 7.2 e- exactly
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.adc_bits = 16;
  mission.ccd.window = 6;
  mission.photometry.method = PhotometryMethod::kMask;
  mission.photometry.background = BackgroundMethod::kKnown;

  const std::vector<double> magnitudes{10.0, 11.0, 12.0};
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(grid(magnitudes)));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const StreamResult result = stream_exposures(scene, plan, estimators, {.threads = 0, .folder = {}, .progress = {}});

  const double nsr_exposure[] = {1.731782e-3, 2.906516e-3, 5.195210e-3};
  const double nsr_hour[] = {29.4582, 49.4408, 88.3723};
  for (std::size_t m = 0; m < magnitudes.size(); ++m) {
    double measured = 0.0;
    double hourly = 0.0;
    double bias = 0.0;
    for (std::size_t t = 400 * m; t < 400 * (m + 1); ++t) {
      EXPECT_EQ(estimators[t].mask_pixels, 9);
      EXPECT_NEAR(estimators[t].nsr_exposure / nsr_exposure[m], 1.0, 1e-6);
      const SeriesSummary& series = result.series[t];
      EXPECT_EQ(series.bins, 100);
      // Unbiased in the mean, not in the square.
      measured += series.exposure.value / 400.0;
      hourly += series.bin_means.value / 400.0;
      bias += series.mean / 400.0;
    }
    // One camera is simulated; independent noise falls with the square root of the number of cameras.
    const double measured_hour = 1e6 * hourly / std::sqrt(kCameras);
    std::printf("P %.0f: NSR %.6e (%.6e), 1 h with 24 cameras %.3f ppm (%.3f), mean %+.2f ppm\n", magnitudes[m],
                measured, nsr_exposure[m], measured_hour, nsr_hour[m], 1e6 * bias);
    EXPECT_NEAR(measured / nsr_exposure[m], 1.0, 0.01);
    EXPECT_NEAR(measured_hour / nsr_hour[m], 1.0, 0.01);
    EXPECT_LT(std::abs(bias), 4.0 * nsr_exposure[m] / std::sqrt(400.0 * 14400.0));
  }
}

}  // namespace
}  // namespace astroid
