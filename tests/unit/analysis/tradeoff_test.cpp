// Which settings are worth their price.
#include "astroid/analysis/tradeoff.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace astroid {
namespace {

TradeoffRow row(double error, double seconds, Sweep sweep = Sweep::kRenderer) {
  return {.sweep = sweep, .error_rms = error, .seconds = seconds};
}

TEST(Pareto, KeepsWhatNothingBeatsInBoth) {
  std::vector<TradeoffRow> rows{row(100.0, 1.0), row(10.0, 2.0), row(50.0, 3.0), row(1.0, 9.0),
                                row(0.5, 1.0, Sweep::kEffect)};
  mark_pareto(rows);
  EXPECT_TRUE(rows[0].pareto && rows[1].pareto && rows[3].pareto);
  EXPECT_FALSE(rows[2].pareto) << "the second is faster and better";
  EXPECT_TRUE(rows[4].pareto) << "of another sweep";
}

TEST(Pareto, TakesTimesWithinTheirNoiseAsEqual) {
  std::vector<TradeoffRow> rows{row(5.0, 1.00), row(5.0, 1.05), row(5.0, 1.30)};
  mark_pareto(rows, 0.1);
  EXPECT_TRUE(rows[0].pareto && rows[1].pareto);
  EXPECT_FALSE(rows[2].pareto);
}

TEST(Pareto, LeavesOutWhatWasNotMeasured) {
  std::vector<TradeoffRow> rows{row(TradeoffRow::kNothing, 1.0), row(3.0, TradeoffRow::kNothing), row(4.0, 1.0)};
  mark_pareto(rows);
  EXPECT_FALSE(rows[0].pareto || rows[1].pareto);
  EXPECT_TRUE(rows[2].pareto);
}

TEST(Knee, IsTheFastestThatIsGoodEnough) {
  const std::vector<TradeoffRow> rows{row(100.0, 1.0), row(9.0, 3.0), row(8.0, 2.0), row(1.0, 0.1, Sweep::kAccuracy)};
  EXPECT_EQ(knee(rows, Sweep::kRenderer, 10.0), 2U);
  EXPECT_EQ(knee(rows, Sweep::kRenderer, 0.5), rows.size());
}

}  // namespace
}  // namespace astroid
