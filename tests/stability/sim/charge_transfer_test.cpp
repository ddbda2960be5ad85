// Hard case N21: thousands of transfers of an efficiency of 0.999999, and the extremes.
#include "astroid/sim/charge_transfer.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace astroid {
namespace {

/// Columns of an image as packets, the first row next to the register.
TransferChain rows_of(std::vector<double>& image, std::size_t width, int first_transfers) {
  TransferChain chain{{}, width, first_transfers};
  for (std::size_t i = 0; i < image.size(); i += width) chain.packets.push_back(image.data() + i);
  return chain;
}

double sum(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

TEST(ChargeTransfer, KeepsAndDefersAsTheBinomialSays) {
  std::vector<double> column(4520, 0.0);
  column[4509] = 1e5;
  const double lost = transfer(rows_of(column, 1, 1), 1e-6);
  EXPECT_NEAR(column[4509] / 1e5, 0.9955001525332642, 1e-12);
  EXPECT_NEAR(column[4510] / 1e5, 4.48970569e-3, 1e-11);
  EXPECT_NEAR(sum(column) + lost, 1e5, 1e-12 * 1e5);
  EXPECT_LT(lost, 1e-10);
  for (int i = 0; i < 4509; ++i) EXPECT_EQ(column[static_cast<std::size_t>(i)], 0.0);
}

TEST(ChargeTransfer, HasTheWholeTrailOfTheLogGammaFunction) {
  // Also where almost nothing stays with its packet, and where (1-e)^N is below the smallest double.
  struct Case {
    double loss;
    int transfers;
  };
  for (const Case& c : {Case{1e-6, 4510}, Case{1e-4, 4510}, Case{0.01, 1000}, Case{0.5, 60}, Case{0.6, 2000}}) {
    std::vector<double> column(4000, 0.0);
    column[0] = 1.0;
    const double lost = transfer(rows_of(column, 1, c.transfers), c.loss);
    EXPECT_NEAR(sum(column) + lost, 1.0, 1e-12) << c.loss;
    const double e = c.loss;
    for (std::size_t k = 0; k < column.size(); ++k) {
      const double n = c.transfers;
      const double kk = static_cast<double>(k);
      const double log_share =
          std::lgamma(n + kk) - std::lgamma(kk + 1.0) - std::lgamma(n) + kk * std::log(e) + n * std::log1p(-e);
      const double share = std::exp(log_share);
      if (share > 1e-12) {
        // What lgamma of large numbers leaves of 16 digits.
        EXPECT_NEAR(column[k] / share, 1.0, 1e-10) << c.loss << ' ' << k;
      }
    }
  }
}

TEST(ChargeTransfer, OfNoLossLeavesTheBitsAlone) {
  std::vector<double> column{1.0, 0.1, -0.0, 5e-324, 1e300};
  const std::vector<double> before = column;
  EXPECT_EQ(transfer(rows_of(column, 1, 4510), 0.0), 0.0);
  for (std::size_t i = 0; i < column.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(column[i]), std::bit_cast<std::uint64_t>(before[i]));
}

TEST(ChargeTransfer, OfTotalLossDefersEverything) {
  std::vector<double> column{1.0, 2.0, 3.0};
  EXPECT_EQ(transfer(rows_of(column, 1, 1), 1.0), 6.0);
  EXPECT_EQ(column, (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(ChargeTransfer, OfNoPacketsIsNothing) {
  EXPECT_EQ(transfer({}, 0.1), 0.0);
  EXPECT_EQ(transfer_through_traps({}, {.species = {{1.0, 1e-20, Seconds(1e-3)}}}), 0.0);
}

TEST(Traps, HoldBackWhateverIsThere) {
  // From nothing over a fraction of an electron to a hundred times the full well; many traps and few; all that there
  // is can be caught, and nothing becomes negative.
  for (const double density : {1e-6, 4.9, 1e6}) {
    for (const double cross_section : {0.0, 1e-30, 2.46e-20, 1e-6}) {
      std::vector<double> column{0.0, 1e-300, 1e-31, 1e-3, 0.7, 1.0, 50.0, 0.0, 1e4, 0.0, 9e5, 9e7, 0.0, 1.0};
      const double before = sum(column);
      const TrapModel model{.species = {{density, cross_section, Seconds(1e-9)},
                                        {density, cross_section, Seconds(1e-3)},
                                        {density, cross_section, Seconds(1e12)}}};
      const double lost = transfer_through_traps(rows_of(column, 1, 4000), model);
      for (const double pixel : column) {
        EXPECT_GE(pixel, 0.0);
        EXPECT_TRUE(std::isfinite(pixel));
      }
      EXPECT_NEAR(sum(column) + lost, before, 1e-12 * before);
    }
  }
}

}  // namespace
}  // namespace astroid
