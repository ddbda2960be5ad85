// Laws of charge transfer: what is lost comes out behind, fast and slow traps, and edges that tell the efficiency.
#include "astroid/sim/charge_transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

namespace astroid {
namespace {

TransferChain rows_of(std::vector<double>& image, std::size_t width, int first_transfers) {
  TransferChain chain{{}, width, first_transfers};
  for (std::size_t i = 0; i < image.size(); i += width) chain.packets.push_back(image.data() + i);
  return chain;
}

double sum(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

/// Stars on a background, different in every column.
std::vector<double> field(std::size_t rows, std::size_t width) {
  std::vector<double> image(rows * width, 1000.0);
  for (std::size_t i = 0; i < image.size(); ++i)
    if ((i * 2654435761U) % 61U == 0) image[i] += static_cast<double>((i * 40503U) % 500000U);
  return image;
}

/// The four species of PLATO's CCDs at the end of life (Jannsen2024).
TrapModel plato_traps() {
  return {.species = {{4.9, 2.46e-20, Seconds(2.37e-4)},
                      {1.655, 1.74e-22, Seconds(2.43e-2)},
                      {0.78, 7.05e-23, Seconds(2.03e-3)},
                      {6.62, 2.45e-23, Seconds(1.40e-1)}},
          .dwell = Seconds(2270 * 340e-9)};
}

TEST(ChargeTransfer, ExtendedPixelEdgeResponseGivesTheEfficiencyBack) {
  // A flat field, then overscan rows that hold nothing but deferred charge: S (1 - (1-e)^N) in the first of them.
  constexpr std::size_t kRows = 4510;
  constexpr double kLevel = 1e5;
  std::vector<double> column(kRows + 30, 0.0);
  std::fill_n(column.begin(), kRows, kLevel);
  const double lost = transfer(rows_of(column, 1, 1), 1e-6);
  const double in_overscan = std::accumulate(column.begin() + kRows, column.end(), lost);
  const double kept = std::exp(kRows * std::log1p(-1e-6));
  EXPECT_NEAR(column[kRows], kLevel * (1.0 - 1e-6) * (1.0 - kept), 1e-7);  // 449.98
  EXPECT_NEAR(in_overscan / (kLevel * kRows), 1e-6, 1e-12);
  // Elsewhere what a row loses it gets back from those before it, but for one transfer.
  for (std::size_t y = 0; y < kRows; ++y) EXPECT_NEAR(column[y], kLevel * (1.0 - 1e-6), 1e-7);
}

TEST(ChargeTransfer, ConservesChargeInAnyImage) {
  for (const double loss : {1e-7, 1e-5, 1e-3, 0.1}) {
    std::vector<double> image = field(700, 9);
    const double before = sum(image);
    const double deferred = transfer(rows_of(image, 9, 1), loss);
    EXPECT_NEAR((sum(image) + deferred) / before, 1.0, 1e-12) << loss;
    EXPECT_GT(deferred, 0.0);
  }
}

TEST(ChargeTransfer, NeedsOnlyTheRowsWithinTheTrail) {
  constexpr std::size_t kWidth = 5;
  constexpr double kLoss = 5e-5;
  std::vector<double> whole = field(3000, kWidth);
  const int reach = trail_length(kLoss, 3000);
  std::printf("a trail of %d rows behind 3000 transfers\n", reach);
  const auto first = static_cast<std::size_t>(2500 - reach);
  std::vector<double> part(whole.begin() + static_cast<std::ptrdiff_t>(first * kWidth),
                           whole.begin() + static_cast<std::ptrdiff_t>(2600 * kWidth));
  transfer(rows_of(whole, kWidth, 1), kLoss);
  transfer(rows_of(part, kWidth, static_cast<int>(first) + 1), kLoss);
  for (std::size_t i = 2500 * kWidth; i < 2600 * kWidth; ++i) EXPECT_EQ(part[i - first * kWidth], whole[i]);
}

TEST(ChargeTransfer, TrailsGrowWithTheWay) {
  int longest = 0;
  for (int transfers = 0; transfers < 5000; transfers += 7) {
    const int length = trail_length(1e-4, transfers);
    EXPECT_GE(length, longest);
    longest = length;
  }
}

TEST(Traps, ConserveCharge) {
  std::vector<double> image = field(2000, 17);
  const double before = sum(image);
  const double lost = transfer_through_traps(rows_of(image, 17, 1), plato_traps());
  EXPECT_NEAR((sum(image) + lost) / before, 1.0, 1e-12);
  EXPECT_GT(lost, 0.0);
  for (const double pixel : image) EXPECT_GE(pixel, 0.0);
}

TEST(Traps, LeaveEverythingAloneWhereThereAreNone) {
  std::vector<double> image = field(100, 7);
  const std::vector<double> before = image;
  EXPECT_EQ(transfer_through_traps(rows_of(image, 7, 1), TrapModel{}), 0.0);
  EXPECT_EQ(image, before);
}

TEST(Traps, TakeWhatTheModelSaysFromAFirstPacket) {
  // One species that captures at once and releases late: (gamma Q^beta) / (gamma Q^(beta-1) + 1) of Q.
  TrapModel model{.species = {{2.0, 1.0, Seconds(1e12)}}};
  constexpr double kCharge = 3e4;
  constexpr int kTransfers = 1000;
  std::vector<double> column{kCharge};
  transfer_through_traps(rows_of(column, 1, kTransfers), model);
  const double beta = model.volume_power;
  const double gamma = 2.0 * 2.0 * kTransfers / (std::pow(9e5, beta) * (1.0 + beta));
  const double captured = gamma * std::pow(kCharge, beta) / (gamma * std::pow(kCharge, beta - 1.0) + 1.0);
  EXPECT_NEAR(kCharge - column[0], captured, 1e-9 * captured);
}

TEST(Traps, TrailWithTheTimeOfTheirRelease) {
  // One packet, then nothing: an exponential of the release time, in rows.
  constexpr double kDwell = 1e-3;
  constexpr double kRelease = 8e-3;
  TrapModel model{.species = {{1.0, 1.0, Seconds(kRelease)}}, .dwell = Seconds(kDwell)};
  std::vector<double> column(60, 0.0);
  column[0] = 1e5;
  // Far from the register, so that every row passes about the same number of traps.
  model.species[0].density = 1e-6;
  transfer_through_traps(rows_of(column, 1, 1000000), model);
  double slope = 0.0;
  for (std::size_t k = 1; k < 20; ++k) slope += std::log(column[k] / column[k + 1]) / 19.0;
  std::printf("e-folding of the trail: %.6f rows, release time %.6f rows\n", 1.0 / slope, kRelease / kDwell);
  EXPECT_GT(column[1], 0.0);
  EXPECT_NEAR(slope, kDwell / kRelease, 1e-9);
}

TEST(Traps, CostABrightPacketASmallerShare) {
  // Where capture takes no time; else a small packet escapes what it has no time to meet.
  TrapModel model = plato_traps();
  for (TrapSpecies& species : model.species) species.cross_section = 1.0;
  double last_share = 1.0;
  for (const double charge : {1e2, 1e3, 1e4, 1e5, 9e5}) {
    std::vector<double> column{charge};
    transfer_through_traps(rows_of(column, 1, 4510), model);
    const double share = 1.0 - column[0] / charge;
    EXPECT_LT(share, last_share) << charge;
    EXPECT_GT(share, 0.0);
    last_share = share;
  }
}

TEST(Traps, AreFilledByALineOfInjectedCharge) {
  // The row behind a charge injection line loses less: its traps are full.
  const auto kept = [](double injected) {
    std::vector<double> column{injected, 0.0, 1e3};
    transfer_through_traps(rows_of(column, 1, 3000), plato_traps());
    return column[2];
  };
  EXPECT_GT(kept(3e5), kept(0.0) + 50.0);
}

}  // namespace
}  // namespace astroid
