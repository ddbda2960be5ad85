// Rolling shutter: every row sees the line of sight and the light of its own time.
#include "astroid/sim/rolling_shutter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kSide = 96;
constexpr double kLine = 0.2;  // s: 19.2 s for the frame

Mission cmos_mission() {
  Mission mission = test::bare_mission(kSide, kSide);
  mission.simulation.type = DetectorType::kCmos;
  mission.simulation.exposures = 20;
  mission.cmos.line_time = Seconds(kLine);
  return mission;
}

std::vector<test::LabStar> column_of_stars() {
  return {{48.2, 10.3, 3e5}, {48.2, 48.1, 3e5}, {48.2, 85.7, 3e5}};
}

struct Made {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  ExposureState state;
};
Made made(const Mission& mission, std::int64_t exposure, const std::vector<test::LabStar>& stars = column_of_stars(),
          const std::function<void(Plan&)>& change = {}) {
  Made m;
  m.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  auto plan = std::make_shared<Plan>(make_plan(*m.scene));
  if (change) change(*plan);
  m.plan = plan;
  const Simulator simulator(m.scene, m.plan, 0);
  m.state = simulator.make_state();
  simulator.expect(exposure, m.state);
  return m;
}

struct Moments {
  double light = 0.0, x = 0.0, y = 0.0;
};
Moments moments_of(const Made& m, std::size_t star) {
  const PixelPosition p = m.scene->stars()[star].position;
  Moments sum;
  for (int y = static_cast<int>(p.y) - 8; y <= static_cast<int>(p.y) + 8; ++y)
    for (int x = static_cast<int>(p.x) - 8; x <= static_cast<int>(p.x) + 8; ++x) {
      const double electrons = m.state.expected.whole().view(0).at(x, y);
      sum.light += electrons;
      sum.x += electrons * x;
      sum.y += electrons * y;
    }
  return {sum.light, sum.x / sum.light, sum.y / sum.light};
}

TEST(RollingShutter, LetsDriftMoveEachRowByItsOwnTime) {
  Mission mission = cmos_mission();
  constexpr double kRate = 3000.0;  // arcsec/d
  mission.satellite.drift.yaw_rate = Arcseconds(kRate);
  const Made rolling = made(mission, 7);
  ASSERT_TRUE(rolling.plan->runs("rolling-shutter"));
  Mission global = mission;
  global.cmos.line_time = Seconds(0.0);
  const Made at_once = made(global, 7);
  ASSERT_FALSE(at_once.plan->runs("rolling-shutter"));
  for (std::size_t star = 0; star < 3; ++star) {
    const AttitudeJacobian& j = rolling.scene->stars()[star].motion;
    const double yaw = kRate / 86400.0 * kLine * rolling.scene->stars()[star].position.y;
    const Moments a = moments_of(rolling, star);
    const Moments b = moments_of(at_once, star);
    // Steps of the attitude are a quarter of an exposure at most, and bands of rows share a time.
    const double step = kRate / 86400.0 *
                        (0.5 * 21.0 / rolling.plan->knobs.attitude_steps + 0.5 * rolling.plan->knobs.band_rows * kLine);
    const double scale = std::hypot(j.dx_dyaw, j.dy_dyaw);
    EXPECT_NEAR(a.x - b.x, j.dx_dyaw * yaw, scale * step + 1e-6) << star;
    EXPECT_NEAR(a.y - b.y, j.dy_dyaw * yaw, scale * step + 1e-6) << star;
    if (star > 0) {
      EXPECT_GT(scale * yaw, 2.0 * scale * step);
    }
  }
}

TEST(RollingShutter, GivesAVariableStarTheTimeOfItsRow) {
  const test::TemporaryFolder folder;
  Mission mission = cmos_mission();
  mission.field.variables =
      folder
          .write("v.csv", "id,kind,amplitude_ppm,period_d\nstar1,sinusoid,200000,0.001\nstar3,sinusoid,200000,0.001\n")
          .string();
  const Made m = made(mission, 5);
  ASSERT_TRUE(m.plan->runs("rolling-shutter"));
  ASSERT_EQ(m.plan->knobs.jitter, JitterTreatment::kNone);
  for (const std::size_t star : {0U, 2U}) {
    const double middle = 5 * 25.0 + 10.5 + kLine * m.scene->stars()[star].position.y;
    const Variability& v =
        m.scene->variables()[static_cast<std::size_t>(m.scene->stars()[star].variability)].variability;
    EXPECT_NEAR(moments_of(m, star).light / 3e5, v.mean(middle - 10.5, middle + 10.5), 1e-6);
  }
  EXPECT_GT(std::fabs(moments_of(m, 0).light - moments_of(m, 2).light), 1000.0);
}

Mission jittering(Arcseconds rms = Arcseconds(1.0)) {
  Mission mission = cmos_mission();
  mission.satellite.jitter = {.model = JitterModel::kRedNoise,
                              .yaw = rms,
                              .pitch = rms,
                              .roll = Arcseconds(0.0),
                              .timescale = Seconds(30.0),
                              .file = {}};
  return mission;
}

TEST(RollingShutter, IsTheSameForEveryTreatmentOfMotion) {
  std::vector<test::LabStar> stars = column_of_stars();
  for (int i = 0; i < 150; ++i)
    stars.push_back({std::fmod(7.31 * i, kSide) - 0.3, std::fmod(11.17 * i, kSide) - 0.4, 2000.0 + 37.0 * i});
  constexpr Arcseconds kCalm{0.1};  // so that maps are the cheapest way
  const Made maps = made(jittering(kCalm), 3, stars);
  ASSERT_EQ(maps.plan->knobs.jitter, JitterTreatment::kPolynomial);
  const Made steps = made(jittering(kCalm), 3, stars, [](Plan& p) { p.knobs.jitter = JitterTreatment::kSubSteps; });
  double worst = 0.0;
  for (std::size_t i = 0; i < maps.plan->layout->size(); ++i)
    worst =
        std::max(worst, std::fabs(maps.state.expected.whole().pixels()[i] - steps.state.expected.whole().pixels()[i]));
  std::printf("maps and steps differ by at most %.3g e- in a pixel\n", worst);
  EXPECT_LT(worst, 1e-6 * 3e5);
}

TEST(RollingShutter, NeedsNoMoreBandsThanThePlanMakes) {
  const Made few = made(jittering(), 3);
  ASSERT_TRUE(few.plan->runs("rolling-shutter"));
  const Made many = made(jittering(), 3, column_of_stars(), [](Plan& p) { p.knobs.band_rows = 1; });
  const SceneSummary& s = few.scene->summary();
  const RowTiming bound(s, Seconds(0.5 * (few.plan->knobs.band_rows - 1) * kLine));
  for (std::size_t star = 0; star < 3; ++star) {
    const double change = moments_of(few, star).light / moments_of(many, star).light - 1.0;
    EXPECT_LT(std::fabs(change), 4.0 * bound.rms + 1e-6) << few.plan->knobs.band_rows << " rows";
  }
  EXPECT_LE(bound.variance_ratio, 0.1 * kVarianceTolerance);
  EXPECT_GT(few.plan->knobs.band_rows, 0);
}

TEST(RollingShutter, OfBandsHasNoSeams) {
  // A star on the border of two bands keeps its light.
  Mission mission = jittering();
  const Made first = made(mission, 3);
  const int rows = first.plan->knobs.band_rows;
  ASSERT_LT(rows, kSide) << "one band has no border";
  const Made border = made(mission, 3, {{40.0, rows * std::floor(kSide / 2.0 / rows) - 0.5, 3e5}});
  EXPECT_NEAR(moments_of(border, 0).light / 3e5, 1.0, 1e-3);
}

TEST(RollingShutter, OfSubPixelsIsThatOfTheIntegratedPsf) {
  Mission mission = jittering();
  const Made analytic = made(mission, 2);
  mission.simulation.renderer = Renderer::kSubPixel;
  const Made map = made(mission, 2);
  double worst = 0.0;
  for (std::size_t i = 0; i < map.plan->layout->size(); ++i)
    worst = std::max(worst,
                     std::fabs(map.state.expected.whole().pixels()[i] - analytic.state.expected.whole().pixels()[i]));
  EXPECT_LT(worst, 3.0);  // 1e-5 of a star
}

TEST(RollingShutter, SkippedBelowItsThresholdIsHarmless) {
  const auto mission_of = [](double line) {
    Mission mission = jittering();
    mission.satellite.jitter.yaw = mission.satellite.jitter.pitch = Arcseconds(0.05);
    mission.cmos.line_time = Seconds(line);
    return mission;
  };
  double low = 0.0;
  double high = kLine;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    const Scene scene(mission_of(middle), test::lab_catalogue(column_of_stars()));
    (make_plan(scene).runs("rolling-shutter") ? high : low) = middle;
  }
  ASSERT_GT(low, 0.0);
  ASSERT_LT(low, 0.99 * kLine) << "it is never needed";
  const Mission mission = mission_of(low);
  // The same process, all rows at the time of the first one, and each at its own.
  const auto run = [](Plan& p) {
    for (PlannedEffect& e : p.effects)
      if (e.effect->spec().name == "rolling-shutter") e.need.needed = true;
  };
  double squares = 0.0;
  double flux = 3e5;
  constexpr int kExposures = 20;
  double ratio = 0.0;
  for (std::int64_t k = 0; k < kExposures; ++k) {
    Mission first = mission;
    first.cmos.line_time = Seconds(1e-9);
    const auto bands = [&](Plan& p) {
      run(p);
      p.knobs.band_rows = 1;
    };
    const Made own = made(mission, k, column_of_stars(), bands);
    const Made at_once = made(first, k, column_of_stars(), bands);
    const double change = moments_of(own, 2).light / moments_of(at_once, 2).light - 1.0;
    squares += change * change / kExposures;
    ratio = own.scene->summary().relative_variance_in_bin(flux);
  }
  std::printf("at %.3g s a line: %.2g of the variance allowed\n", low, squares / ratio / kVarianceTolerance);
  EXPECT_LE(squares, kVarianceTolerance * ratio);
}

}  // namespace
}  // namespace astroid
