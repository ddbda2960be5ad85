// Gaussian numbers for tests: a fixed sequence that owes nothing to the code under test.
#pragma once

#include <cmath>
#include <cstdint>

namespace astroid::test {

/// Standard normal numbers by Box and Muller from SplitMix64 (Steele, Lea & Flood 2014).
class GaussianSeries {
 public:
  explicit GaussianSeries(std::uint64_t seed) : state_(seed) {}

  double uniform() {  // in (0, 1)
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return (static_cast<double>(z >> 11) + 0.5) * 0x1p-53;
  }

  double next() {
    constexpr double kTwoPi = 6.283185307179586476925286766559;
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(kTwoPi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace astroid::test
