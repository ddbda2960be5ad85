// Motion within an exposure: broadening is the limit of many sub-steps, and both agree with F26.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

/// Flux in 3 x 3 px around a centred star of one electron, seen by a Gaussian of 0.6 px that moves with covariance `s`.
double aperture_flux(const PixelPsf& psf, PixelPosition centre, const MotionCovariance& s) {
  std::vector<double> fractions(9);
  std::vector<double> scratch;
  psf.integrate_broadened(centre, s, {-1, -1, 3, 3}, fractions, scratch);
  double sum = 0.0;
  for (const double f : fractions) sum += f;
  return sum;
}

TEST(Broadening, OfAGaussianIsF26) {
  const auto psf = make_gaussian_psf(0.6);
  const double still = aperture_flux(*psf, {0.0, 0.0}, {});
  const struct {
    double s, ppm;
  } golden[] = {{0.0025333, -1.582028}, {0.01, -24.65642}, {0.05, -619.6460}, {0.1, -2518.474}};
  for (const auto& [s, ppm] : golden) {
    const double moved = aperture_flux(*psf, {0.0, 0.0}, {.sxx = s * s, .sxy = 0.0, .syy = s * s});
    EXPECT_NEAR(1e6 * (moved / still - 1.0), ppm, 1e-5 * std::abs(ppm));
  }
}

/// The mean of stamps moved with a two-dimensional normal distribution, by a fine sum over it.
double mean_of_moved(const PixelPsf& psf, PixelPosition centre, const MotionCovariance& s) {
  const double sx = std::sqrt(s.sxx);
  const double rho = s.sxy / std::sqrt(s.sxx * s.syy);
  const double rest = std::sqrt(s.syy * (1.0 - rho * rho));
  double sum = 0.0;
  double weights = 0.0;
  constexpr int kSteps = 60;
  constexpr double kReach = 6.0;
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double u = kReach * i / kSteps;
      const double v = kReach * j / kSteps;
      const double w = std::exp(-0.5 * (u * u + v * v));
      const double dx = sx * u;
      const double dy = std::sqrt(s.syy) * rho * u + rest * v;
      sum += w * aperture_flux(psf, {centre.x + dx, centre.y + dy}, {});
      weights += w;
    }
  return sum / weights;
}

TEST(Broadening, IsTheMeanOfMovedStampsToSecondOrder) {
  const auto psf = make_gaussian_psf(0.6);
  for (const double s : {0.01, 0.05}) {
    for (const double rho : {0.0, 0.8, -0.5}) {
      const MotionCovariance motion{.sxx = s * s, .sxy = rho * 0.7 * s * s, .syy = 0.49 * s * s};
      const PixelPosition centre{0.31, -0.22};
      const double still = aperture_flux(*psf, centre, {});
      const double truth = mean_of_moved(*psf, centre, motion) / still - 1.0;
      const double gaussian = aperture_flux(*psf, centre, motion) / still - 1.0;
      std::vector<double> fractions(9);
      std::vector<double> scratch;
      psf->PixelPsf::integrate_broadened(centre, motion, {-1, -1, 3, 3}, fractions, scratch);  // the rule for any PSF
      double rule = -still;
      for (const double f : fractions) rule += f;
      rule /= still;
      const double next_order = std::pow(s / 0.6, 4.0);
      std::printf("s %.2f rho %+.1f: mean %.4f ppm, Gaussian %.4f, rule %.4f\n", s, rho, 1e6 * truth, 1e6 * gaussian,
                  1e6 * rule);
      EXPECT_NEAR(gaussian, truth, next_order);
      EXPECT_NEAR(rule, truth, next_order);
      EXPECT_GT(std::abs(truth), 10.0 * next_order);
    }
  }
}

/// Expected electrons of a run with a given treatment.
std::vector<double> expected(const Scene& scene, JitterTreatment treatment, int steps) {
  auto plan = std::make_shared<Plan>(make_plan(scene));
  plan->knobs.jitter = treatment;
  plan->knobs.attitude_steps = steps;
  const Simulator simulator(std::shared_ptr<const Scene>(&scene, [](const Scene*) {}), plan, 0);
  ExposureState state = simulator.make_state();
  simulator.expect(1, state);
  return {state.expected.whole().pixels().begin(), state.expected.whole().pixels().end()};
}

TEST(JitterTreatment, BroadeningIsTheLimitOfSubSteps) {
  Mission mission = test::bare_mission(24, 24);
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(1.5);  // 0.1 px
  mission.satellite.jitter.timescale = Seconds(5.0);
  const Scene scene(mission, test::lab_catalogue({{11.7, 12.2, 1.0}}));
  constexpr int kSteps = 200;
  const std::vector<double> steps = expected(scene, JitterTreatment::kSubSteps, kSteps);
  const std::vector<double> broadened = expected(scene, JitterTreatment::kBroadened, kSteps);
  const std::vector<double> shifted = expected(scene, JitterTreatment::kShift, kSteps);
  double worst_broadened = 0.0;
  double worst_shifted = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    worst_broadened = std::max(worst_broadened, std::abs(broadened[i] - steps[i]));
    worst_shifted = std::max(worst_shifted, std::abs(shifted[i] - steps[i]));
  }
  std::printf("largest pixel error: shift %.2e, broadened %.2e of the flux\n", worst_shifted, worst_broadened);
  EXPECT_LT(worst_broadened, 0.1 * worst_shifted);
  EXPECT_GT(worst_shifted, 1e-4);
}

/// Expected electrons in 3 x 3 px about (21, 20) by the plan at an accuracy, on the path of a more exact one.
double planned_light(Mission mission, const StarCatalogue& stars, double ppm, JitterTreatment& treatment) {
  mission.simulation.accuracy = Ppm(ppm);
  const auto scene = std::make_shared<const Scene>(mission, stars);
  constexpr int kSteps = 200;
  const auto plan = std::make_shared<const Plan>(make_plan(*scene, {}, kSteps));
  treatment = plan->knobs.jitter;
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  double sum = 0.0;
  for (int exposure = 0; exposure < 4; ++exposure) {
    simulator.expect(exposure, state);
    for (int y = 19; y <= 21; ++y)
      for (int x = 20; x <= 22; ++x) sum += state.expected.whole().view(0).at(x, y);
  }
  return sum;
}

// The wing of a brighter star is steeper than the core of a star: light in an aperture there bends more with motion
// than that of a star alone, which is broadened only where that matters.
TEST(JitterTreatment, ThinksOfBrighterNeighbours) {
  Mission mission = test::bare_mission(40, 40);
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.045);
  const std::vector<test::LabStar> alone{{21.2, 20.1, 1e6}};
  const std::vector<test::LabStar> beside{{21.2, 20.1, 1e6}, {17.9, 20.4, 4e8}};
  mission.ccd.full_well = Electrons(5e5);  // of the bright star, which is no target that matters
  for (const auto& [stars, expected] :
       {std::pair{alone, JitterTreatment::kShift}, std::pair{beside, JitterTreatment::kBroadened}}) {
    JitterTreatment treatment{};
    JitterTreatment exact{};
    const double truth = planned_light(mission, test::lab_catalogue(stars), 0.001, exact);
    const double light = planned_light(mission, test::lab_catalogue(stars), 1.0, treatment);
    EXPECT_EQ(treatment, expected);
    std::printf("%zu stars: %s errs by %.3g ppm\n", stars.size(), std::string(to_string(treatment)).c_str(),
                1e6 * (light / truth - 1.0));
    EXPECT_LT(std::abs(light / truth - 1.0), 1e-6);
  }
}

TEST(NeighbourCurvature, IsThatOfTheLightInTheAperture) {
  Mission mission = test::bare_mission(40, 40);
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = Arcseconds(0.05);
  EXPECT_EQ(Scene(mission, test::lab_catalogue({{21.2, 20.1, 1e6}})).summary().neighbour_curvature, 1.0);
  EXPECT_EQ(Scene(mission, test::lab_catalogue({{11.2, 20.1, 1e6}, {31.2, 20.1, 1e6}})).summary().neighbour_curvature,
            1.0)
      << "far apart";
  mission.ccd.full_well = Electrons(5e5);  // of the bright star, which is no target that matters
  const std::vector<test::LabStar> stars{{21.2, 20.1, 1e6}, {17.9, 20.4, 4e8}};
  const Scene scene(mission, test::lab_catalogue(stars));
  // By hand: light of both and its second difference along x, in 3 and 5 px.
  double most = 1.0;
  for (const int side : {3, 5}) {
    const Rectangle mask{21 - side / 2, 20 - side / 2, side, side};
    const auto light = [&](double shift) {
      double sum = 0.0;
      std::vector<double> fractions(mask.size());
      for (const test::LabStar& star : stars) {
        scene.psf().integrate({star.x + shift, star.y}, mask, fractions);
        for (const double f : fractions) sum += star.electrons * f;
      }
      return sum;
    };
    constexpr double kStep = 0.05;  // px
    const double bend = std::abs(light(kStep) - 2.0 * light(0.0) + light(-kStep)) / (kStep * kStep);
    const SceneSummary& s = scene.summary();
    const double weight = s.flux_tolerance(1e6) / 1e6 / (s.flux_tolerance(light(0.0)) / light(0.0));
    most = std::max(most, bend / light(0.0) / s.psf.curvature * weight);
  }
  std::printf("curvature: %.3f times a star's own, by hand %.3f\n", scene.summary().neighbour_curvature, most);
  EXPECT_GT(most, 2.0);
  EXPECT_NEAR(scene.summary().neighbour_curvature / most, 1.0, 0.05);
}

}  // namespace
}  // namespace astroid
