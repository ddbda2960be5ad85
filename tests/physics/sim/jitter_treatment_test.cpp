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

}  // namespace
}  // namespace astroid
