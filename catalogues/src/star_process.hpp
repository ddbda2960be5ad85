// Stars of a count law as the arrivals of a Poisson process along magnitude, each addressed by its number.
#pragma once

#include <cstdint>

#include "astroid/catalogues/sky_region.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/random.hpp"

namespace astroid {

/// The random numbers of synthetic stars: n counts from 1.
class StarProcess {
 public:
  explicit StarProcess(std::uint64_t seed);
  /// Exponential of mean 1: how many expected stars lie between star n - 1 and star n.
  [[nodiscard]] double gap(std::uint64_t n) const;
  /// Uniform in (0, 1), for keeping or dropping star n.
  [[nodiscard]] double chance(std::uint64_t n) const;
  /// Where star n stands, rounded to 1e-8 deg.
  [[nodiscard]] SkyPosition position(std::uint64_t n, const SkyRegion& region) const;

 private:
  RandomStream stream_;
};

inline constexpr double kMagnitudeStep = 1e-4;  // mag

/// A magnitude as files write it: to kMagnitudeStep.
[[nodiscard]] double rounded_magnitude(double magnitude);

/// More synthetic stars than that are an error of the request, not a field.
inline constexpr double kMostSyntheticStars = 1e8;

}  // namespace astroid
