// The kernels that move charge: against their plain twins bit for bit, and against the formula with the C library.
#include "astroid/core/charge_kernels.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/vector_target.hpp"

namespace astroid {
namespace {

class ChargeKernels : public testing::TestWithParam<std::string> {
 protected:
  ChargeKernels() { force_vector_target(GetParam()); }
  ~ChargeKernels() override { force_vector_target({}); }
  ChargeKernels(const ChargeKernels&) = delete;
  ChargeKernels& operator=(const ChargeKernels&) = delete;
  ChargeKernels(ChargeKernels&&) = delete;
  ChargeKernels& operator=(ChargeKernels&&) = delete;
};

INSTANTIATE_TEST_SUITE_P(Targets, ChargeKernels, testing::ValuesIn(vector_targets()),
                         [](const auto& target) { return target.param; });

/// Nothing, next to nothing, and from 1e-40 to 1e9 in an order without system.
std::vector<double> charges(std::size_t size) {
  std::vector<double> values(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double u = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
    values[i] = i % 11 == 0 ? 0.0 : std::pow(10.0, (i % 7 == 0 ? 49.0 : 12.0) * u - (i % 7 == 0 ? 40.0 : 3.0));
  }
  return values;
}

std::vector<TrapPassage> passages() {
  std::vector<TrapPassage> all;
  for (const double traps : {0.0, 1e-3, 20.0, 4e3})
    for (const double rate : {0.0, 1e-6, 0.01, 1.3, 1e9})
      for (const double power : {0.0, 0.37, 1.0}) all.push_back({power, traps, rate, 0.3});
  return all;
}

void expect_same_bits(const std::vector<double>& kernel, const std::vector<double>& plain) {
  for (std::size_t i = 0; i < kernel.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(kernel[i]), std::bit_cast<std::uint64_t>(plain[i])) << "element " << i;
}

TEST_P(ChargeKernels, HaveTheBitsOfTheirTwins) {
  for (const std::size_t size : {0U, 1U, 2U, 3U, 7U, 8U, 9U, 12U, 31U, 400U}) {
    for (const TrapPassage& passage : passages()) {
      std::vector<double> charge = charges(size);
      std::vector<double> filled(size, 3.0);
      std::vector<double> plain_charge = charge;
      std::vector<double> plain_filled = filled;
      for (int i = 0; i < 3; ++i) {
        pass_traps(passage, charge, filled);
        reference::pass_traps(passage, plain_charge, plain_filled);
      }
      expect_same_bits(charge, plain_charge);
      expect_same_bits(filled, plain_filled);
    }
    const std::vector<double> other = charges(size);
    std::vector<double> sum(size, 0.1);
    std::vector<double> plain_sum = sum;
    add_scaled(sum, 0.3, other);
    reference::add_scaled(plain_sum, 0.3, other);
    expect_same_bits(sum, plain_sum);
  }
}

TEST(TrapPassage, AgreesWithThePlainFormula) {
  const std::vector<double> before = charges(3000);
  for (const TrapPassage& p : passages()) {
    std::vector<double> charge = before;
    std::vector<double> filled(before.size(), 0.5);
    pass_traps(p, charge, filled);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const long double q = before[i];
      long double captured = 0.0L;
      if (before[i] > 1e-30) {
        const long double beta = p.volume_power;
        captured = (p.traps * std::pow(q, beta) - 0.5L) / (p.traps * std::pow(q, beta - 1.0L) + 1.0L);
        captured = std::fmax(captured, 0.0L) * -std::expm1(-p.capture_rate * std::pow(q, 1.0L - beta));
      }
      const long double held = 0.5L + captured;
      // 1 - exp(-x) loses the digits of a small x: absolute 1e-16 of what there is to capture.
      EXPECT_NEAR(filled[i], static_cast<double>(held * 0.7L), 2e-14 * static_cast<double>(held + q)) << before[i];
      EXPECT_NEAR(charge[i], static_cast<double>(q - captured + held * 0.3L), 2e-14 * static_cast<double>(held + q));
      EXPECT_GE(charge[i], 0.0);
    }
  }
}

TEST(TrapPassage, RefusesTrapsOfAnotherNumber) {
  std::vector<double> charge(3);
  std::vector<double> filled(2);
  EXPECT_THROW(pass_traps({}, charge, filled), BugError);
  EXPECT_THROW(add_scaled(charge, 1.0, filled), BugError);
}

}  // namespace
}  // namespace astroid
