// Charge transfer against a register that is shifted step by step, and traps against the loop of the paper.
#include "astroid/sim/charge_transfer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace astroid {
namespace {

/// Every pixel hands on its charge at every step, but for a share that the next packet finds.
std::vector<double> shift_step_by_step(std::vector<double> column, double efficiency, std::size_t reads) {
  std::vector<double> read;
  for (std::size_t step = 0; step < reads; ++step) {
    read.push_back(efficiency * column.front());
    for (std::size_t y = 0; y + 1 < column.size(); ++y)
      column[y] = (1.0 - efficiency) * column[y] + efficiency * column[y + 1];
    column.back() *= 1.0 - efficiency;
  }
  return read;
}

TransferChain chain_of(std::vector<double>& column) {
  TransferChain chain{{}, 1, 1};
  for (double& pixel : column) chain.packets.push_back(&pixel);
  return chain;
}

TEST(ChargeTransfer, IsAShiftRegister) {
  constexpr std::size_t kRows = 300;
  constexpr std::size_t kOverscan = 200;
  std::vector<double> column(kRows);
  for (std::size_t i = 0; i < kRows; ++i) column[i] = static_cast<double>((i * 2654435761U) % 100003U);
  for (const double loss : {1e-5, 1e-3, 0.03, 0.4}) {
    const std::vector<double> expected = shift_step_by_step(column, 1.0 - loss, kRows + kOverscan);
    std::vector<double> moved = column;
    moved.resize(kRows + kOverscan, 0.0);
    transfer(chain_of(moved), loss);
    for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_NEAR(moved[i], expected[i], 1e-8) << loss << ' ' << i;
  }
}

/// The loop of Short et al. with the C library, packet by packet.
double traps_one_by_one(std::vector<double>& column, const TrapModel& m, int first_transfers) {
  const double volume = std::pow(m.pixel_pitch * 1e-6, 2) * 1e-6 / 2.0;
  const double velocity = std::sqrt(3.0 * 1.380649e-23 * m.temperature / (0.5 * 9.1093837015e-31));
  const double full = std::pow(m.full_well.value(), m.volume_power);
  std::vector<double> occupied(m.species.size(), 0.0);
  for (std::size_t i = 0; i < column.size(); ++i) {
    for (std::size_t k = 0; k < m.species.size(); ++k) {
      const TrapSpecies& s = m.species[k];
      const double alpha = m.dwell.value() * s.cross_section * velocity * full / (2.0 * volume);
      const double transfers = first_transfers + static_cast<double>(i);
      const double gamma = 2.0 * s.density * transfers / (full * (1.0 + m.volume_power));
      double captured = 0.0;
      if (column[i] > 0.0) {
        captured = (gamma * std::pow(column[i], m.volume_power) - occupied[k]) /
                   (gamma * std::pow(column[i], m.volume_power - 1.0) + 1.0) *
                   (1.0 - std::exp(-alpha * std::pow(column[i], 1.0 - m.volume_power)));
        captured = std::max(captured, 0.0);
      }
      occupied[k] += captured;
      const double released = occupied[k] * (1.0 - std::exp(-m.dwell.value() / s.release.value()));
      occupied[k] -= released;
      column[i] += released - captured;
    }
  }
  double lost = 0.0;
  for (const double n : occupied) lost += n;
  return lost;
}

TEST(Traps, AreThoseOfTheLoopOfThePaper) {
  const TrapModel model{.species = {{4.9, 2.46e-20, Seconds(2.37e-4)},
                                    {1.655, 1.74e-22, Seconds(2.43e-2)},
                                    {0.78, 7.05e-23, Seconds(2.03e-3)},
                                    {6.62, 2.45e-23, Seconds(1.40e-1)}},
                        .dwell = Seconds(2270 * 340e-9)};
  for (const int first : {1, 3000}) {
    std::vector<double> expected(1000);
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = i % 50 == 7 ? 3e5 : static_cast<double>((i * 40503U) % 1000U);
    std::vector<double> moved = expected;
    TransferChain chain = chain_of(moved);
    chain.first_transfers = first;
    const double lost = transfer_through_traps(chain, model);
    EXPECT_NEAR(lost, traps_one_by_one(expected, model, first), 1e-7);
    for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_NEAR(moved[i], expected[i], 1e-7) << i;
  }
}

}  // namespace
}  // namespace astroid
