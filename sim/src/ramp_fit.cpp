#include "astroid/sim/ramp_fit.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/frame.hpp"

namespace astroid {

namespace {

// Levels are the leading bits of φ: four steps to a factor of two, so that φ is off by at most an eighth.
constexpr unsigned kDroppedBits = 50;  // of the 52 of a mantissa
constexpr std::uint64_t kLowest = std::bit_cast<std::uint64_t>(0x1p-18) >> kDroppedBits;
constexpr std::uint64_t kHighest = std::bit_cast<std::uint64_t>(0x1p13) >> kDroppedBits;
constexpr std::uint64_t kSteps = kHighest - kLowest;  // between the level without photons and that without noise

constexpr std::uint8_t kSaturated = pixel_flag::kFullWell | pixel_flag::kAdcSaturated;

}  // namespace

RampLadder::RampLadder(RampFit fit, int reads, double read_variance)
    : intervals_(reads - 1), per_electron_(photons_per_read_noise(fit, 1.0, reads - 1, read_variance)) {
  ASTROID_CHECK_LE(2, reads);
  if (fit == RampFit::kOptimal) {
    weights_.emplace_back(intervals_, 0.0);
    for (std::uint64_t bits = kLowest; bits < kHighest; ++bits)
      weights_.emplace_back(intervals_, 0.5 * (std::bit_cast<double>(bits << kDroppedBits) +
                                               std::bit_cast<double>((bits + 1) << kDroppedBits)));
    weights_.emplace_back(intervals_, std::numeric_limits<double>::infinity());
  } else {
    weights_.emplace_back(intervals_, per_electron_);
  }
  for (int i = 1; i <= intervals_; ++i) {
    for (const RampWeights& w : weights_) {
      carries_.push_back(w.carry(i));
      shares_.push_back(w.share(i));
      scales_.push_back(static_cast<double>(intervals_) / w.information(i));
    }
  }
}

std::uint8_t RampLadder::level(double electrons) const {
  if (weights_.size() == 1 || !(electrons > 0.0)) return 0;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(electrons * per_electron_) >> kDroppedBits;
  return static_cast<std::uint8_t>(bits < kLowest ? 0 : std::min(bits - kLowest, kSteps) + 1);
}

void take_ramp_read(const RampLadder& ladder, int read, std::span<const float> counts,
                    std::span<const std::uint8_t> flags, const RampPixels& pixels) {
  const std::size_t size = counts.size();
  ASTROID_CHECK_EQ(flags.size(), size);
  ASTROID_CHECK_EQ(pixels.previous.size(), size);
  if (read == 0) {
    std::ranges::copy(counts, pixels.previous.begin());
    std::ranges::fill(pixels.carried, 0.0);
    std::ranges::fill(pixels.numerator, 0.0);
    std::ranges::fill(pixels.used, std::uint8_t{0});
    return;
  }
  const std::span<const double> carries = ladder.carries(read);
  const std::span<const double> shares = ladder.shares(read);
  for (std::size_t i = 0; i < size; ++i) {
    if ((flags[i] & kSaturated) != 0) continue;
    const std::size_t level = pixels.level[i];
    const double increment = static_cast<double>(counts[i]) - static_cast<double>(pixels.previous[i]);
    const double carried = increment + carries[level] * pixels.carried[i];
    pixels.carried[i] = carried;
    pixels.numerator[i] += shares[level] * carried;
    pixels.previous[i] = counts[i];
    ++pixels.used[i];
  }
}

void finish_ramp(const RampLadder& ladder, double saturated, const RampPixels& pixels, std::span<double> counts,
                 std::span<std::uint8_t> flags) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int used = pixels.used[i];
    if (used == 0) {
      counts[i] = saturated;
      continue;
    }
    counts[i] = pixels.numerator[i] * ladder.scales(used)[pixels.level[i]];
    if (used < ladder.intervals())
      flags[i] = static_cast<std::uint8_t>((flags[i] & ~kSaturated) | pixel_flag::kShortRamp);
  }
}

}  // namespace astroid
