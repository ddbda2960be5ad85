// The deterministic functions against glibc's 80-bit ones, and a fingerprint of their bits.
#include "astroid/core/math.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "inline_exponential.hpp"

namespace astroid {
namespace {

struct Function {
  std::string name;
  double (*fast)(double);
  long double (*exact)(long double);
  double low;
  double high;
  double ulps;  ///< as stated in math.hpp; 0.02 for the 80-bit reference itself is added
};

long double exp10_long(long double x) {
  return std::pow(10.0L, x);
}

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {
      {"exp", det::exp, std::exp, -708.0, 709.0, 1.0},       {"exp near 0", det::exp, std::exp, -1.0, 1.0, 1.0},
      {"exp10", det::exp10, exp10_long, -300.0, 300.0, 1.0}, {"expm1", det::expm1, std::expm1, -1.0, 1.0, 1.0},
      {"log", det::log, std::log, 1e-300, 1e9, 1.0},         {"log near 1", det::log, std::log, 0.5, 2.0, 1.0},
      {"log10", det::log10, std::log10, 1e-9, 1e9, 1.0},     {"log1p", det::log1p, std::log1p, -0.9, 1.0, 1.0},
      {"sin", det::sin, std::sin, -100.0, 100.0, 1.0},       {"sin far", det::sin, std::sin, 1e9, 1e10, 1.0},
      {"cos", det::cos, std::cos, -100.0, 100.0, 1.0},       {"tan", det::tan, std::tan, -100.0, 100.0, 1.0},
      {"asin", det::asin, std::asin, -1.0, 1.0, 1.0},        {"acos", det::acos, std::acos, -1.0, 1.0, 1.0},
      {"atan", det::atan, std::atan, -50.0, 50.0, 1.0},      {"tanh", det::tanh, std::tanh, -9.0, 9.0, 1.0},
      {"erf", det::erf, std::erf, -4.0, 4.0, 1.0},           {"erfc", det::erfc, std::erfc, -3.0, 26.0, 1.5},
  };
  return all;
}

/// |a - b| in units in the last place of a double at b.
double error_in_ulps(double a, long double b) {
  const double magnitude = std::fabs(static_cast<double>(b));
  const double ulp = std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
  return static_cast<double>(std::fabs(static_cast<long double>(a) - b) / static_cast<long double>(ulp));
}

constexpr int kPoints = 20000;
constexpr double kReferenceUlps = 0.02;  // several units of the 64-bit significand

double argument(const Function& f, int i) {
  return f.low + (f.high - f.low) * (i + 0.5) / kPoints;
}

TEST(DeterministicMath, IsAccurateToTheStatedUlps) {
  for (const Function& f : functions()) {
    double worst = 0.0;
    double where = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double x = argument(f, i);
      const double error = error_in_ulps(f.fast(x), f.exact(static_cast<long double>(x)));
      if (error > worst) worst = error, where = x;
    }
    EXPECT_LE(worst, f.ulps + kReferenceUlps) << f.name << " at " << where;
  }
}

TEST(DeterministicMath, PowersAnglesAndLengthsAreAccurate) {
  for (int i = 0; i < kPoints; ++i) {
    const double x = 1e-3 + 7.3 * i / kPoints;
    const double y = 20.0 * std::fmod(i * 0.6180339887, 1.0) - 10.0;
    EXPECT_LE(error_in_ulps(det::pow(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y))), 1.02);
    EXPECT_LE(error_in_ulps(det::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))),
              1.02);
    EXPECT_LE(error_in_ulps(det::hypot(x, y), std::hypot(static_cast<long double>(x), static_cast<long double>(y))),
              0.52);
  }
}

TEST(DeterministicMath, KeepsTheSpecialValuesOfC) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(det::exp(-infinity), 0.0);
  EXPECT_EQ(det::exp(0.0), 1.0);
  EXPECT_EQ(det::exp(1000.0), infinity);
  EXPECT_EQ(det::log(0.0), -infinity);
  EXPECT_EQ(det::log(1.0), 0.0);
  EXPECT_TRUE(std::isnan(det::log(-1.0)));
  EXPECT_TRUE(std::isnan(det::asin(1.5)));
  EXPECT_EQ(det::erf(infinity), 1.0);
  EXPECT_EQ(det::erfc(infinity), 0.0);
  EXPECT_EQ(det::pow(0.0, 0.0), 1.0);
  EXPECT_EQ(det::pow(10.0, 2.0), 100.0);
  EXPECT_TRUE(std::isnan(det::sin(infinity)));
  EXPECT_TRUE(std::isnan(det::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST(InlineExponential, IsAccurate) {
  for (int i = 0; i < kPoints; ++i) {
    const double x = -10.0 + 11.0 * i / kPoints;
    const long double exact = std::exp(static_cast<long double>(x));
    EXPECT_LE(std::fabs(static_cast<long double>(inline_exponential(x)) / exact - 1.0L), 4e-16L) << x;
  }
  EXPECT_EQ(inline_exponential(0.0), 1.0);
  EXPECT_EQ(inline_exponential(-1e-300), 1.0);
}

// A different processor, emulator or compiler must print the same number. Made with SLEEF 3.5.1 on x86-64.
TEST(DeterministicMath, HasTheSameBitsEverywhere) {
  constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325U;  // FNV-1a, 64 bits
  constexpr std::uint64_t kFnvPrime = 0x100000001b3U;
  std::uint64_t hash = kFnvBasis;
  const auto add = [&hash](double value) { hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * kFnvPrime; };
  for (const Function& f : functions())
    for (int i = 0; i < kPoints; ++i) add(f.fast(argument(f, i)));
  for (int i = 1; i < kPoints; ++i) {
    const double x = static_cast<double>(i) / 1024.0;
    add(det::pow(x, 0.4));
    add(det::atan2(x, 3.0));
    add(det::hypot(x, 3.0));
  }
  EXPECT_EQ(hash, 0xf7f522359908094cU) << std::hex << hash;
}

}  // namespace
}  // namespace astroid
