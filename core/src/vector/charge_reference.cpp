// The kernels of charge_kernels.hpp number by number: the same operations in the same order, so the same bits.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "astroid/core/charge_kernels.hpp"
#include "astroid/core/error.hpp"
#include "vector/charge_fits.hpp"

namespace astroid::reference {

namespace {

template <std::size_t N>
double polynomial(double x, const std::array<double, N>& coefficient) {
  double sum = coefficient[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + coefficient[i];
  return sum;
}

double log_of(double x) {
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(x) + (charge_fits::kOneBits - charge_fits::kSqrtHalfBits);
  const std::uint64_t biased = shifted >> charge_fits::kMantissaBits;
  const double exponent =
      std::bit_cast<double>(biased + charge_fits::kRounderBits) - (charge_fits::kRounder + charge_fits::kExponentBias);
  const auto mantissa = std::bit_cast<double>((shifted & charge_fits::kMantissaMask) + charge_fits::kSqrtHalfBits);
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  return exponent * charge_fits::kLn2 + s * polynomial(s * s, charge_fits::kLog);
}

double exp_of(double x) {
  const double shifted = x * charge_fits::kLog2E + charge_fits::kRounder;
  const double k = shifted - charge_fits::kRounder;
  const double r = (x - k * charge_fits::kLn2High) - k * charge_fits::kLn2Low;
  const std::uint64_t scale =
      (std::bit_cast<std::uint64_t>(shifted) << charge_fits::kMantissaBits) + charge_fits::kOneBits;
  return polynomial(r, charge_fits::kExp) * std::bit_cast<double>(scale);
}

}  // namespace

void add_scaled(std::span<double> values, double factor, std::span<const double> other) {
  ASTROID_CHECK_EQ(values.size(), other.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = values[i] + factor * other[i];
}

void pass_traps(const TrapPassage& passage, std::span<double> charge, std::span<double> filled) {
  ASTROID_CHECK_EQ(charge.size(), filled.size());
  for (std::size_t i = 0; i < charge.size(); ++i) {
    const bool some = charge[i] > charge_fits::kLeastCharge;
    const double packet = some ? charge[i] : 1.0;
    const double volume = exp_of(passage.volume_power * log_of(packet));
    const double reach = passage.traps * volume;
    const double share = packet / (reach + packet);
    const double exponent = std::max(-passage.capture_rate * packet / volume, charge_fits::kLeastExponent);
    const double room = (reach - filled[i]) * share;
    const double captured = some ? std::max(0.0, room) * (1.0 - exp_of(exponent)) : 0.0;
    const double held = filled[i] + captured;
    const double released = held * passage.released;
    filled[i] = held - released;
    charge[i] = (charge[i] - captured) + released;
  }
}

}  // namespace astroid::reference
