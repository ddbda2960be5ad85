// What is smeared along the columns: the light of all rows, in all rows, whichever pixels are computed.
#include "astroid/sim/smearing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 60;
constexpr int kRows = 80;
constexpr double kSky = 10.0;  // e-/px/s

Mission smeared_mission(SmearingModel model) {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.field.sky_background = ElectronsPerSecond(kSky);
  mission.ccd.smearing = {.model = model, .time = Seconds(4.0), .clear_time = Seconds(4.0)};
  mission.ccd.reference = {.prescan = 5, .serial_overscan = 3, .parallel_overscan = 12};
  return mission;
}

std::vector<test::LabStar> stars() {
  // One on the edge of the first row, one near the last, one in the middle, and one beside the detector.
  return {{20.2, -0.4, 3e6}, {30.7, 78.9, 2e6}, {41.1, 40.3, 5e6}, {-2.0, 30.0, 1e7}};
}

struct Expectation {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  ExposureState state;
  [[nodiscard]] double at(std::size_t region, int x, int y) const {
    return state.expected.whole().view(region).at(x, y);
  }
  [[nodiscard]] std::span<const Rectangle> regions() const { return plan->layout->regions(); }
};

Expectation expectation(const Mission& mission, const std::vector<test::LabStar>& field = stars()) {
  Expectation e;
  e.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(field));
  e.plan = std::make_shared<const Plan>(make_plan(*e.scene));
  const Simulator simulator(e.scene, e.plan, 0);
  e.state = simulator.make_state();
  simulator.expect(0, e.state);
  return e;
}

// Light of a column below a row, half of its own included, and of all of it, from an image that is not smeared.
struct ColumnSums {
  std::vector<double> below;
  double all = 0.0;
};
ColumnSums sums_of(const Expectation& image, int x) {
  ColumnSums sums;
  for (int y = 0; y < kRows; ++y) {
    const double own = image.at(0, x, y);
    sums.below.push_back(sums.all + 0.5 * own);
    sums.all += own;
  }
  return sums;
}

constexpr double kShare = 4.0 / 21.0 / kRows;
// The stamps' truncation, and rounding.
double tolerance(double smeared) {
  return 1e-6 * smeared + 1e-4;
}

TEST(OpenShutterSmearing, AddsTheMeanOfTheColumnToEachOfItsPixels) {
  const Expectation sharp = expectation(smeared_mission(SmearingModel::kNone));
  const Expectation smeared = expectation(smeared_mission(SmearingModel::kOpenShutter));
  ASSERT_TRUE(smeared.plan->runs("open-shutter-smearing"));
  ASSERT_FALSE(smeared.plan->runs("frame-transfer-smearing"));
  ASSERT_EQ(smeared.regions().size(), 4U);  // the frame, prescan, serial overscan, overscan
  for (int x = 0; x < kColumns; ++x) {
    const double expected = kShare * sums_of(sharp, x).all;
    for (int y = 0; y < kRows; ++y)
      ASSERT_NEAR(smeared.at(0, x, y) - sharp.at(0, x, y), expected, tolerance(expected)) << x << "," << y;
    for (int y = kRows; y < kRows + 12; ++y) ASSERT_NEAR(smeared.at(3, x, y), expected, tolerance(expected)) << x;
    for (int y = kRows + 1; y < kRows + 12; ++y) ASSERT_EQ(smeared.at(3, x, y), smeared.at(3, x, kRows));
  }
  for (const std::size_t region : {1U, 2U})
    for (int y = 0; y < kRows; ++y) EXPECT_EQ(smeared.at(region, smeared.regions()[region].x0, y), 0.0);
}

TEST(OpenShutterSmearing, OfWindowsComesFromTheWholeColumn) {
  const Expectation full = expectation(smeared_mission(SmearingModel::kOpenShutter));
  Mission windows = smeared_mission(SmearingModel::kOpenShutter);
  windows.ccd.window = 6;
  Mission sub = smeared_mission(SmearingModel::kOpenShutter);
  sub.ccd.has_sub_field = true;
  sub.ccd.sub_x0 = 17;
  sub.ccd.sub_y0 = 50;
  sub.ccd.sub_columns = 9;
  sub.ccd.sub_rows = 4;
  for (const Mission& mission : {windows, sub}) {
    const Expectation part = expectation(mission);
    std::size_t overscan = 0;
    for (std::size_t r = 0; r < part.regions().size(); ++r) {
      const Rectangle& area = part.regions()[r];
      if (area.x0 < 0 || area.x0 >= kColumns) continue;
      const bool is_overscan = area.y0 >= kRows;
      overscan += is_overscan ? area.size() : 0;
      for (int y = area.y0; y < area.y1(); ++y)
        for (int x = area.x0; x < area.x1(); ++x)
          ASSERT_EQ(part.at(r, x, y), full.at(is_overscan ? 3 : 0, x, y)) << x << "," << y;
    }
    EXPECT_GE(overscan, 9U * 12U);
  }
}

TEST(OpenShutterSmearing, FollowsTheStarsToFirstOrder) {
  const Mission mission = smeared_mission(SmearingModel::kOpenShutter);
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars()));
  const SmearedColumns columns(*scene, 0, kColumns);
  // 0.3 arcsec are 0.02 px. Stars moved by hand tell what is right.
  const Attitude attitude{0.3, -0.2, 5.0};
  std::vector<test::LabStar> moved;
  for (const SceneStar& star : scene->stars()) {
    const PixelShift shift = displacement(star.motion, attitude);
    moved.push_back({star.position.x + shift.dx, star.position.y + shift.dy, star.electrons});
  }
  const Scene there(mission, test::lab_catalogue(moved));
  std::vector<double> first_order(kColumns);
  std::vector<double> exact(kColumns);
  std::vector<double> unmoved(kColumns);
  columns.at(attitude, 1.0, 0, first_order);
  columns.at({}, 1.0, 0, unmoved);
  SmearedColumns(there, 0, kColumns).at({}, 1.0, 0, exact);
  double change = 0.0;
  double error = 0.0;
  for (std::size_t i = 0; i < kColumns; ++i) {
    change = std::max(change, std::fabs(exact[i] - unmoved[i]));
    error = std::max(error, std::fabs(exact[i] - first_order[i]));
  }
  std::printf("motion changes a column by %.3g e-, of which first order leaves %.3g e-\n", change, error);
  EXPECT_GT(change, 10.0);
  EXPECT_LT(error, 0.05 * change);  // (0.02 px / 0.6 px) of it
}

TEST(FrameTransferSmearing, IsOpenShutterSmearingWhereBothTransfersTakeTheSameTime) {
  const Expectation read = expectation(smeared_mission(SmearingModel::kOpenShutter));
  const Expectation moved = expectation(smeared_mission(SmearingModel::kFrameTransfer));
  ASSERT_TRUE(moved.plan->runs("frame-transfer-smearing"));
  for (std::size_t i = 0; i < read.plan->layout->size(); ++i)
    ASSERT_EQ(read.state.expected.whole().pixels()[i], moved.state.expected.whole().pixels()[i]);
}

TEST(FrameTransferSmearing, WeighsRowsByTheTransferThatPassesThem) {
  const Expectation sharp = expectation(smeared_mission(SmearingModel::kNone));
  for (const double clear : {0.0, 1.5, 6.0}) {
    Mission mission = smeared_mission(SmearingModel::kFrameTransfer);
    mission.ccd.smearing.clear_time = Seconds(clear);
    const Expectation smeared = expectation(mission);
    for (int x = 0; x < kColumns; ++x) {
      const ColumnSums sums = sums_of(sharp, x);
      for (int y = 0; y < kRows; ++y) {
        const double below = sums.below[static_cast<std::size_t>(y)];
        const double expected = kShare * (below + clear / 4.0 * (sums.all - below));
        // What is missing from above is kept in single precision.
        ASSERT_NEAR(smeared.at(0, x, y) - sharp.at(0, x, y), expected, tolerance(kShare * sums.all)) << x << "," << y;
      }
      ASSERT_NEAR(smeared.at(3, x, kRows), kShare * sums.all, tolerance(kShare * sums.all));
    }
  }
}

/// Rows of one half with four nodes, and the overscan region that goes with it.
struct Half {
  int y0, y1;
  std::size_t overscan;
};
constexpr Half kLower{0, 41, 4};  // 81 rows: the middle one belongs to the lower half
constexpr Half kUpper{41, 81, 3};

Mission four_nodes(SmearingModel model) {
  Mission mission = smeared_mission(model);
  mission.ccd.rows = 81;
  mission.ccd.nodes.count = 4;
  return mission;
}

TEST(OpenShutterSmearing, OfFourNodesIsThatOfEachHalf) {
  const Expectation sharp = expectation(four_nodes(SmearingModel::kNone));
  const Expectation smeared = expectation(four_nodes(SmearingModel::kOpenShutter));
  ASSERT_TRUE(smeared.plan->runs("open-shutter-smearing"));
  ASSERT_EQ(smeared.regions().size(), 5U);  // the frame, prescan, serial overscan, overscan above and below
  EXPECT_EQ(smeared.regions()[3], (Rectangle{0, 81, kColumns, 12}));
  EXPECT_EQ(smeared.regions()[4], (Rectangle{0, -12, kColumns, 12}));
  double difference = 0.0;
  for (int x = 0; x < kColumns; ++x) {
    double of_lower = 0.0;
    for (const Half& half : {kLower, kUpper}) {
      double light = 0.0;
      for (int y = half.y0; y < half.y1; ++y) light += sharp.at(0, x, y);
      const double expected = light * 4.0 / 21.0 / (half.y1 - half.y0);
      for (int y = half.y0; y < half.y1; ++y)
        ASSERT_NEAR(smeared.at(0, x, y) - sharp.at(0, x, y), expected, tolerance(expected)) << x << "," << y;
      const Rectangle& overscan = smeared.regions()[half.overscan];
      for (int y = overscan.y0; y < overscan.y1(); ++y)
        ASSERT_NEAR(smeared.at(half.overscan, x, y), expected, tolerance(expected)) << x << "," << y;
      if (half.y0 == 0) of_lower = expected;
      difference = std::max(difference, std::fabs(expected - of_lower));
    }
  }
  EXPECT_GT(difference, 1000.0) << "the halves are to differ";
}

TEST(FrameTransferSmearing, OfFourNodesWeighsRowsByTheWayToTheirRegister) {
  const Expectation sharp = expectation(four_nodes(SmearingModel::kNone));
  for (const double clear : {0.0, 1.5, 4.0}) {
    Mission mission = four_nodes(SmearingModel::kFrameTransfer);
    mission.ccd.smearing.clear_time = Seconds(clear);
    const Expectation smeared = expectation(mission);
    for (int x = 0; x < kColumns; ++x)
      for (const Half& half : {kLower, kUpper}) {
        const int rows = half.y1 - half.y0;
        double all = 0.0;
        for (int y = half.y0; y < half.y1; ++y) all += sharp.at(0, x, y);
        double before = 0.0;  // of the rows that lie between a row and its register
        for (int number = 0; number < rows; ++number) {
          const int y = half.y0 == 0 ? number : half.y1 - 1 - number;
          const double own = sharp.at(0, x, y);
          const double passed = before + 0.5 * own;
          const double expected = (4.0 * passed + clear * (all - passed)) / 21.0 / rows;
          ASSERT_NEAR(smeared.at(0, x, y) - sharp.at(0, x, y), expected, tolerance(all * 4.0 / 21.0 / rows))
              << x << "," << y;
          before += own;
        }
      }
  }
}

// Hard case N34: columns without light, rows without light.
TEST(Smearing, OfNothingIsNothing) {
  Mission mission = smeared_mission(SmearingModel::kOpenShutter);
  mission.field.sky_background = ElectronsPerSecond(0.0);
  const Expectation dark = expectation(mission, {{50.0, 40.0, 1e8}});
  EXPECT_EQ(dark.at(0, 5, 40), 0.0);
  EXPECT_EQ(dark.at(3, 5, kRows), 0.0);
  for (const double value : dark.state.expected.whole().pixels()) EXPECT_TRUE(std::isfinite(value) && value >= 0.0);
  Mission line = test::bare_mission(kColumns, 1);
  line.ccd.smearing = mission.ccd.smearing;
  const Expectation row = expectation(line, {{30.0, 0.0, 1e6}});
  for (const double value : row.state.expected.whole().pixels()) EXPECT_TRUE(std::isfinite(value) && value >= 0.0);
}

TEST(Smearing, IsLeftOutWithAShutter) {
  const Expectation sharp = expectation(smeared_mission(SmearingModel::kNone));
  EXPECT_FALSE(sharp.plan->runs("open-shutter-smearing"));
  EXPECT_TRUE(smeared_electrons(*sharp.scene).empty());
}

}  // namespace
}  // namespace astroid
