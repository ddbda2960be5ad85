// Stars that aberration moves, by an image that is a polynomial in time, against the rendering of every exposure.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/aperture_fluxes.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 96;
constexpr std::size_t kStars = 400;

StarCatalogue crowd() {
  const RandomStream stream = make_stream(6, StreamId{78}, 0, 0);
  std::vector<test::LabStar> stars;
  for (std::size_t i = 0; i < kStars; ++i) {
    const auto u = [&](std::uint32_t axis) { return uniform_at_step(stream, {.step = i, .axis = axis}); };
    stars.push_back({kSide * u(0) - 0.5, kSide * u(1) - 0.5, std::min(1.5e6, 4000.0 * std::pow(u(2), -0.75 / 0.57))});
  }
  return test::lab_catalogue(stars);
}

/// Half a quarter, 15 deg from the boresight.
Mission mission(bool jitter) {
  Mission mission = test::plato_mission(kSide, kSide);
  if (!jitter) mission.satellite.jitter = {};
  mission.simulation.exposures = 150000;
  mission.satellite.aberration = true;
  mission.ccd.axis_x = 3600.0;
  return mission;
}

/// The same plan with every exposure rendered under its own conditions.
std::shared_ptr<Plan> rendering(const Plan& plan, JitterTreatment treatment) {
  auto exact = std::make_shared<Plan>(plan);
  exact->knobs.jitter = treatment;
  exact->knobs.polynomial = {};
  exact->still = false;
  exact->epoch_exposures = 1;
  return exact;
}

void expect_within_share(bool jitter) {
  const auto scene = std::make_shared<const Scene>(mission(jitter), crowd());
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_EQ(plan->knobs.jitter, JitterTreatment::kPolynomial);
  ASSERT_GT(plan->knobs.polynomial.highest_power_of_time(), 0);
  EXPECT_GE(plan->epoch_exposures, 100);
  const Simulator recalled(scene, plan, 0);
  const Simulator rendered(scene, rendering(*plan, jitter ? JitterTreatment::kSubSteps : JitterTreatment::kNone), 0);
  ExposureState a = recalled.make_state();
  ExposureState b = rendered.make_state();
  // At both ends of epochs, where a polynomial is at its worst, and between.
  const std::int64_t length = plan->epoch_exposures;
  const std::int64_t last = mission(jitter).simulation.exposures - 1;
  double worst = 0.0;
  double moved = 0.0;
  std::vector<double> first;
  for (const std::int64_t exposure :
       {std::int64_t{0}, length / 5, length - 1, length, std::min(last, 7 * length / 2), last}) {
    recalled.expect(exposure, a);
    rendered.expect(exposure, b);
    const std::vector<double> fast = test::aperture_fluxes(*scene, a);
    const std::vector<double> exact = test::aperture_fluxes(*scene, b);
    if (first.empty()) first = exact;
    for (std::size_t t = 0; t < fast.size(); ++t) {
      worst = std::max(worst, std::abs(fast[t] - exact[t]) / scene->summary().flux_tolerance(exact[t]));
      moved = std::max(moved, std::abs(exact[t] / first[t] - 1.0));
    }
  }
  std::printf(
      "%zu terms, up to power %d of time, epochs of %lld exposures: %.3f of what is allowed, while fluxes change by "
      "%.2g\n",
      plan->knobs.polynomial.terms.size(), plan->knobs.polynomial.highest_power_of_time(),
      static_cast<long long>(length), worst, moved);
  EXPECT_LT(worst, 0.3);  // the share of motion
  EXPECT_GT(moved, 1e-4);
}

TEST(SlowMotion, KeepsEveryFluxWithinTheAccuracy) {
  expect_within_share(false);
}

TEST(SlowMotion, KeepsEveryFluxWithinTheAccuracyWhileTheSpacecraftJitters) {
  expect_within_share(true);
}

TEST(SlowMotion, HasTheSameBitsInAWindowAndAfterOtherExposures) {
  Mission windows = mission(true);
  windows.ccd.window = 9;
  const auto whole_scene = std::make_shared<const Scene>(mission(true), crowd());
  const auto window_scene = std::make_shared<const Scene>(windows, crowd());
  const auto whole_plan = std::make_shared<const Plan>(make_plan(*whole_scene));
  const auto window_plan = std::make_shared<const Plan>(make_plan(*window_scene));
  EXPECT_EQ(whole_plan->epoch_exposures, window_plan->epoch_exposures);
  const Simulator whole(whole_scene, whole_plan, 0);
  const Simulator window(window_scene, window_plan, 0);
  const std::int64_t length = whole_plan->epoch_exposures;
  ExposureState a = whole.make_state();
  ExposureState b = window.make_state();
  // The window's own simulator begins with the later epoch.
  for (const std::int64_t exposure : {length + 3, std::int64_t{5}}) {
    whole.expect(5, a);
    whole.expect(exposure, a);
    window.expect(exposure, b);
    const std::span<const Rectangle> regions = window_plan->layout->exposed_regions();
    for (std::size_t r = 0; r < regions.size(); ++r)
      for (int y = regions[r].y0; y < regions[r].y1(); ++y)
        for (int x = regions[r].x0; x < regions[r].x1(); ++x)
          ASSERT_EQ(b.expected.whole().view(r).at(x, y), a.expected.whole().view(0).at(x, y)) << x << " " << y;
  }
}

TEST(SlowMotion, IsPlannedAlikeForALongerRun) {
  Mission longer = mission(false);
  longer.simulation.exposures *= 3;
  const Scene one(mission(false), crowd());
  const Scene three(longer, crowd());
  const Plan a = make_plan(one);
  const Plan b = make_plan(three);
  EXPECT_EQ(a.epoch_exposures, b.epoch_exposures);
  EXPECT_EQ(a.knobs.polynomial.terms, b.knobs.polynomial.terms);
  EXPECT_NE(to_text(a, one).find("powers of time"), std::string::npos);
}

}  // namespace
}  // namespace astroid
