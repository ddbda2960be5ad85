#include "star_process.hpp"

#include <array>
#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr StreamId kSyntheticStars{1001};  // beyond those of the simulator's effects; never changed
constexpr std::uint32_t kPositionDraw = 0;
constexpr std::uint32_t kMagnitudeDraw = 1;

double uniform(std::uint32_t high, std::uint32_t low) {
  constexpr unsigned kDroppedBits = 12;  // 52 remain: with the half below, every value is exact
  constexpr double kStep = 0x1.0p-52;
  const std::uint64_t word = (std::uint64_t{high} << 32U | low) >> kDroppedBits;
  return (static_cast<double>(word) + 0.5) * kStep;
}

RandomWords words_of(const RandomStream& stream, std::uint64_t n, std::uint32_t draw) {
  return philox4x32(stream, {static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(n >> 32U), 0U, draw});
}

double rounded(double value, double steps) {
  return std::round(value * steps) / steps;
}

}  // namespace

StarProcess::StarProcess(std::uint64_t seed) : stream_(make_stream(seed, kSyntheticStars, 0, 0)) {}

double StarProcess::gap(std::uint64_t n) const {
  const RandomWords words = words_of(stream_, n, kMagnitudeDraw);
  return -det::log(uniform(words[0], words[1]));
}

double StarProcess::chance(std::uint64_t n) const {
  const RandomWords words = words_of(stream_, n, kMagnitudeDraw);
  return uniform(words[2], words[3]);
}

SkyPosition StarProcess::position(std::uint64_t n, const SkyRegion& region) const {
  constexpr double kSteps = 1e8;  // per deg: 0.04 mas
  const RandomWords words = words_of(stream_, n, kPositionDraw);
  const SkyPosition exact = point_of(region, uniform(words[0], words[1]), uniform(words[2], words[3]));
  const double ra = rounded(exact.ra, kSteps);
  return {ra >= 360.0 ? 0.0 : ra, rounded(exact.dec, kSteps)};
}

double rounded_magnitude(double magnitude) {
  return rounded(magnitude, 1.0 / kMagnitudeStep);
}

}  // namespace astroid
