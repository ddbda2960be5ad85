// Variable targets and contaminants in the expected image: exact averages over each exposure, however the image is
// made.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kSide = 32;
constexpr double kSigma = 0.6;
constexpr Rectangle kMask{12, 12, 6, 6};

StarCatalogue field() {
  // A target, a contaminant at the edge of its mask, and what makes a polynomial worth its maps.
  std::vector<test::LabStar> stars{{14.6, 14.3, 2e5}, {17.8, 15.1, 5e4}};
  for (int i = 0; i < 80; ++i)
    stars.push_back({std::fmod(7.31 * i, kSide) - 0.3, std::fmod(11.17 * i, kSide) - 0.4, 2000.0 + 37.0 * i});
  return test::lab_catalogue(stars);
}

double light(const SceneStar& star, const PixelShift& shift, double variance_x, double variance_y) {
  const auto part = [](double low, double high, double centre, double sigma) {
    const double scale = 1.0 / (std::sqrt(2.0) * sigma);
    return 0.5 * (std::erf((high - centre) * scale) - std::erf((low - centre) * scale));
  };
  return star.electrons *
         part(kMask.x0 - 0.5, kMask.x1() - 0.5, star.position.x + shift.dx, std::sqrt(kSigma * kSigma + variance_x)) *
         part(kMask.y0 - 0.5, kMask.y1() - 0.5, star.position.y + shift.dy, std::sqrt(kSigma * kSigma + variance_y));
}

double mask_sum(const ExposureState& state) {
  double sum = 0.0;
  for (int y = kMask.y0; y < kMask.y1(); ++y)
    for (int x = kMask.x0; x < kMask.x1(); ++x) sum += state.expected.whole().view(0).at(x, y);
  return sum;
}

class VariableStarsInTheImage : public testing::TestWithParam<bool> {};

TEST_P(VariableStarsInTheImage, HaveTheirExposuresMean) {
  const test::TemporaryFolder folder;
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.exposures = 400;
  mission.field.variables =
      folder
          .write("variables.csv",
                 "id,kind,amplitude_ppm,period_d,depth_ppm,duration_h,ingress_h,epoch_d,secondary_ppm\n"
                 "star1,transit,,0.05,8400,0.3,0.02,0.02,\n"
                 "star1,sinusoid,500,0.003,,,,,\n"
                 "star2,eclipse,,0.02,400000,0.05,0.02,0.004,150000\n")
          .string();
  if (GetParam()) {
    mission.satellite.jitter.model = JitterModel::kRedNoise;
    mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.038);
  }
  Mission constant = mission;
  constant.field.variables.clear();
  const auto scene = std::make_shared<const Scene>(mission, field());
  const auto calm = std::make_shared<const Scene>(constant, field());
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_TRUE(plan->runs("variable-stars"));
  EXPECT_EQ(plan->knobs.jitter, GetParam() ? JitterTreatment::kPolynomial : JitterTreatment::kNone);
  const Simulator varying(scene, plan, 0);
  const Simulator steady(calm, std::make_shared<const Plan>(make_plan(*calm)), 0);
  ExposureState a = varying.make_state();
  ExposureState b = steady.make_state();
  double worst = 0.0;
  double deepest = 0.0;
  for (std::int64_t k = 0; k < mission.simulation.exposures; ++k) {
    varying.expect(k, a);
    steady.expect(k, b);
    double expected = mask_sum(b);
    for (std::size_t i = 0; i < 2; ++i) {
      const SceneStar& star = scene->stars()[i];
      const double begin = static_cast<double>(k) * 25.0;
      const double change =
          scene->variables()[static_cast<std::size_t>(star.variability)].variability.mean(begin, begin + 21.0) - 1.0;
      const MotionCovariance motion = motion_covariance(star.motion, a.attitude.covariance);
      expected += change * light(star, displacement(star.motion, a.attitude.mean), motion.sxx, motion.syy);
      deepest = std::min(deepest, change);
    }
    worst = std::max(worst, 1e6 * std::abs(mask_sum(a) / expected - 1.0));
  }
  std::printf("%s: light within %.2g ppm of the exact average; the deepest eclipse is %.3f\n",
              std::string(to_string(plan->knobs.jitter)).c_str(), worst, deepest);
  EXPECT_LT(deepest, -0.39);
  EXPECT_LT(worst, 0.3);  // of motion, by the polynomial
}

INSTANTIATE_TEST_SUITE_P(StillAndMoving, VariableStarsInTheImage, testing::Bool());

TEST(VariableStars, BelowTheirThresholdAreHarmless) {
  const test::TemporaryFolder folder;
  Mission mission = test::bare_mission(kSide, kSide);
  const Scene plain(mission, field());
  const double tolerance = plain.summary().tightest_tolerance();
  const auto with_amplitude = [&](double electrons) {
    mission.field.variables = folder
                                  .write("variables.csv", "id,kind,amplitude_ppm,period_d\nstar1,sinusoid," +
                                                              std::to_string(1e6 * electrons / 2e5) + ",0.001\n")
                                  .string();
    return std::make_shared<const Scene>(mission, field());
  };
  EXPECT_TRUE(make_plan(*with_amplitude(1.01 * tolerance)).runs("variable-stars"));
  const auto scene = with_amplitude(0.98 * tolerance);
  const auto off = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_FALSE(off->runs("variable-stars"));
  auto on = std::make_shared<Plan>(*off);
  for (PlannedEffect& effect : on->effects)
    if (effect.effect->spec().name == "variable-stars") effect.need.needed = true;
  on->knobs.variables = true;
  const Simulator without(scene, off, 0);
  const Simulator with(scene, on, 0);
  ExposureState a = without.make_state();
  ExposureState b = with.make_state();
  double worst = 0.0;
  for (std::int64_t k = 0; k < 4; ++k) {
    without.expect(k, a);
    with.expect(k, b);
    worst = std::max(worst, std::abs(mask_sum(a) - mask_sum(b)));
  }
  EXPECT_LE(worst, tolerance);
  EXPECT_GT(worst, 0.0);
}

TEST(VariableStars, MustBeInTheCatalogue) {
  const test::TemporaryFolder folder;
  Mission mission = test::bare_mission(kSide, kSide);
  mission.field.variables =
      folder.write("variables.csv", "id,kind,amplitude_ppm,period_d\nnobody,sinusoid,1,1\n").string();
  EXPECT_THROW(Scene(mission, field()), InputError);
}

TEST(ProperMotionInTheScene, MovesStarsToTheMiddleOfTheRun) {
  Mission mission = test::bare_mission(200, 200);
  mission.field.catalogue_epoch = 2016.0;
  mission.photometry.target_limit = Magnitude(20.0);
  StarCatalogue catalogue;
  catalogue.source = "laboratory";
  catalogue.passband = "P";
  CatalogueStar star;
  star.id = "A";
  star.sky = {mission.satellite.ra.value(), mission.satellite.dec.value()};
  star.magnitude = Magnitude(10.0);
  star.pm_ra = 3000.0;
  star.pm_dec = -6000.0;
  catalogue.stars.push_back(star);
  const Scene scene(mission, catalogue);
  // 11.0 years of 3 and 6 arcsec at 15 arcsec/px; x grows to the west.
  const double years = scene.summary().epoch - 2016.0;
  EXPECT_NEAR(years, 11.0, 0.01);
  EXPECT_NEAR(scene.stars()[0].position.x - 99.5, -3.0 * years / 15.0, 1e-4);
  EXPECT_NEAR(scene.stars()[0].position.y - 99.5, -6.0 * years / 15.0, 1e-4);
  EXPECT_TRUE(make_plan(scene).runs("proper-motion"));
  mission.field.proper_motion = false;
  const Scene still(mission, catalogue);
  EXPECT_NEAR(still.stars()[0].position.x, 99.5, 1e-6);
  EXPECT_FALSE(make_plan(still).runs("proper-motion"));
}

}  // namespace
}  // namespace astroid
