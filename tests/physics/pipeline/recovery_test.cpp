// Magnitudes come back: no floor, no clipping, no bias, however faint the star.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

/// Mean relative deviation of the flux from what is expected, its standard error, and the number of stars.
struct Bias {
  double mean = 0.0, error = 0.0;
};

Bias bias_of(double electrons, PhotometryMethod method, BackgroundMethod background, double gain) {
  constexpr int kPerSide = 12;
  Mission mission = test::plato_mission(32 * kPerSide, 32 * kPerSide);
  mission.simulation.exposures = 144;
  mission.satellite.jitter.model = JitterModel::kNone;
  mission.ccd.prnu = 0.0;
  mission.ccd.dsnu = 0.0;
  mission.ccd.gain = Gain(gain);
  mission.photometry.method = method;
  mission.photometry.background = background;
  std::vector<test::LabStar> stars;
  for (int i = 0; i < kPerSide * kPerSide; ++i)
    stars.push_back({16.0 + 32.0 * (i % kPerSide) + 0.07 * (i % 13) - 0.4,
                     16.0 + 32.0 * (i / kPerSide) + 0.09 * (i % 11) - 0.45, electrons});
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const StreamResult result = stream_exposures(scene, plan, estimators, {.threads = 0, .folder = {}, .progress = {}});
  Bias bias;
  const auto n = static_cast<double>(estimators.size());
  double squares = 0.0;
  for (const SeriesSummary& series : result.series) {
    bias.mean += series.mean / n;
    squares += series.mean * series.mean / n;
  }
  bias.error = std::sqrt((squares - bias.mean * bias.mean) / (n - 1.0));
  return bias;
}

struct Case {
  const char* name;
  PhotometryMethod method;
  BackgroundMethod background;
};
class Recovery : public testing::TestWithParam<Case> {};

TEST_P(Recovery, FaintAndBrightStarsAreUnbiased) {
  for (const double electrons : {100.0, 1000.0, 1e5, 1e6}) {
    const Bias bias = bias_of(electrons, GetParam().method, GetParam().background, 25.0);
    const double z = bias.mean / bias.error;
    std::printf("%-16s %8.0f e-: %+.3e +- %.1e, z = %+.2f\n", GetParam().name, electrons, bias.mean, bias.error, z);
    EXPECT_LT(std::abs(z), 3.5);
    // Where three standard errors allow the statement, the magnitude is right to a millimagnitude.
    constexpr double kMillimagnitude = 0.921e-3;
    if (3.0 * bias.error < kMillimagnitude) {
      EXPECT_LT(std::abs(bias.mean), kMillimagnitude);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Recovery,
                         testing::Values(Case{"mask known", PhotometryMethod::kMask, BackgroundMethod::kKnown},
                                         Case{"mask local", PhotometryMethod::kMask, BackgroundMethod::kLocal},
                                         Case{"aperture local", PhotometryMethod::kAperture, BackgroundMethod::kLocal},
                                         Case{"weighted known", PhotometryMethod::kWeighted, BackgroundMethod::kKnown},
                                         Case{"psf local", PhotometryMethod::kPsf, BackgroundMethod::kLocal}),
                         [](const testing::TestParamInfo<Case>& parameter) {
                           std::string name = parameter.param.name;
                           name[name.find(' ')] = '_';
                           return name;
                         });

}  // namespace
}  // namespace astroid
