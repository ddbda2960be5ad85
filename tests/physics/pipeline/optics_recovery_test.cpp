// Vignetting and ageing take light away, and nothing else: what the ground expects of a star is what it finds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/core/throughput.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 480;

/// 20 deg from the axis in its far corner; three tenths of the light are lost there.
Mission mission_with(PhotometryMethod method, BackgroundMethod background) {
  Mission mission = test::plato_mission(kSide, kSide);
  mission.ccd.pixel_scale = PixelScale(100.0);
  mission.ccd.axis_x = mission.ccd.axis_y = 0.0;
  mission.telescope.vignetting.model = VignettingModel::kPolynomial;
  mission.telescope.vignetting.polynomial = {0.08};
  mission.telescope.throughput = {
      .beginning_of_life = 0.9, .end_of_life = 0.95, .lifetime_years = 6.5, .age_years = 3.0};
  mission.simulation.exposures = 72;
  mission.satellite.jitter.model = JitterModel::kNone;
  mission.ccd.prnu = 0.0;
  mission.ccd.dsnu = 0.0;
  mission.photometry.method = method;
  mission.photometry.background = background;
  return mission;
}

struct Case {
  const char* name;
  PhotometryMethod method;
  BackgroundMethod background;
};
class RecoveryBehindTheOptics : public testing::TestWithParam<Case> {};

TEST_P(RecoveryBehindTheOptics, IsUnbiasedAndAsNoisyAsPredicted) {
  const Mission mission = mission_with(GetParam().method, GetParam().background);
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 196; ++i)
    stars.push_back(
        {24.0 + 33.0 * (i % 14) + 0.07 * (i % 13) - 0.4, 24.0 + 33.0 * (i / 14) + 0.09 * (i % 11) - 0.45, 2e4});
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_TRUE(plan->runs("vignetting"));
  ASSERT_TRUE(plan->runs("throughput"));
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const StreamResult result = stream_exposures(scene, plan, estimators, {.threads = 0, .folder = {}, .progress = {}});
  // Of each star in units of its standard error, so that all count alike; and separately where much light is lost.
  double sum = 0.0;
  double corner = 0.0;
  double variance_ratio = 0.0;
  std::size_t in_corner = 0;
  const auto exposures = static_cast<double>(mission.simulation.exposures);
  for (std::size_t t = 0; t < estimators.size(); ++t) {
    const StarEstimator& e = estimators[t];
    const double error = std::sqrt(e.budget.variance() / exposures) / e.budget.target;
    const double z = result.series[t].mean / error;
    sum += z;
    const double measured = result.series[t].exposure.value;
    variance_ratio += measured * measured / (error * error * exposures);
    if (scene->stars()[t].response > 0.85 * mean_throughput(mission)) continue;
    corner += z;
    ++in_corner;
  }
  const auto n = static_cast<double>(estimators.size());
  const double z_all = sum / std::sqrt(n);
  const double z_corner = corner / std::sqrt(static_cast<double>(in_corner));
  const double z_variance = (variance_ratio / n - 1.0) / std::sqrt(2.0 / (n * (exposures - 1.0)));
  std::printf("%-16s mean z = %+.2f, of %zu dark places %+.2f; variance / predicted = %.4f, z = %+.2f\n",
              GetParam().name, z_all, in_corner, z_corner, variance_ratio / n, z_variance);
  EXPECT_LT(std::abs(z_all), 3.5);
  EXPECT_LT(std::abs(z_corner), 3.5);
  EXPECT_LT(std::abs(z_variance), 3.5);
}

INSTANTIATE_TEST_SUITE_P(Methods, RecoveryBehindTheOptics,
                         testing::Values(Case{"mask known", PhotometryMethod::kMask, BackgroundMethod::kKnown},
                                         Case{"mask local", PhotometryMethod::kMask, BackgroundMethod::kLocal},
                                         Case{"psf local", PhotometryMethod::kPsf, BackgroundMethod::kLocal}),
                         [](const testing::TestParamInfo<Case>& parameter) {
                           std::string name = parameter.param.name;
                           name[name.find(' ')] = '_';
                           return name;
                         });

}  // namespace
}  // namespace astroid
