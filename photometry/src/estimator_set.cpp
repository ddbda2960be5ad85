#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"
#include "batch_flux.hpp"

namespace astroid {

namespace {

// Several running sums hide the latency of addition; their number and the order in which they meet are fixed.
constexpr std::size_t kLanes = 4;

double combine(const std::array<double, kLanes>& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

double weighted_sum(std::span<const std::uint32_t> pixel, std::span<const float> weight, const float* counts) {
  std::array<double, kLanes> lanes{};
  std::size_t i = 0;
  for (; i + kLanes <= pixel.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      lanes[lane] += static_cast<double>(weight[i + lane]) * static_cast<double>(counts[pixel[i + lane]]);
  for (; i < pixel.size(); ++i)
    lanes[i % kLanes] += static_cast<double>(weight[i]) * static_cast<double>(counts[pixel[i]]);
  return combine(lanes);
}

double plain_sum(std::span<const std::uint32_t> pixel, const float* counts) {
  std::array<double, kLanes> lanes{};
  std::size_t i = 0;
  for (; i + kLanes <= pixel.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] += static_cast<double>(counts[pixel[i + lane]]);
  for (; i < pixel.size(); ++i) lanes[i % kLanes] += static_cast<double>(counts[pixel[i]]);
  return combine(lanes);
}

/// A flag without what only the simulation knows.
constexpr std::uint8_t seen(unsigned flag) {
  return static_cast<std::uint8_t>(flag & ~pixel_flag::kTruth);
}

std::uint8_t any_flag(std::span<const std::uint32_t> pixel, const std::uint8_t* flags) {
  unsigned any = 0;
  for (const std::uint32_t p : pixel) any |= flags[p];
  return seen(any);
}

std::uint32_t aperture_flags(std::uint8_t pixel_flags) {
  constexpr unsigned kSaturatedBits = pixel_flag::kFullWell | pixel_flag::kAdcSaturated;
  std::uint32_t flags = 0;
  if ((pixel_flags & kSaturatedBits) != 0U) flags |= measurement_flag::kSaturated;
  if ((pixel_flags & pixel_flag::kBad) != 0U) flags |= measurement_flag::kBadPixel;
  return flags;
}

// Frames are interleaved some hundred pixels at a time, just before they are read.
constexpr std::size_t kStep = 256;

std::size_t whole_steps(std::size_t pixels) {
  return (pixels + kStep - 1) / kStep * kStep;
}

}  // namespace

EstimatorSet::EstimatorSet(std::span<const StarEstimator> estimators, Gain gain, Adu bias)
    : gain_(gain.value()), bias_(bias.value()) {
  std::vector<std::size_t> order(estimators.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto first_pixel = [&estimators](std::size_t i) {
    return estimators[i].terms.empty() ? std::numeric_limits<std::uint32_t>::max() : estimators[i].terms.front().pixel;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&first_pixel](std::size_t a, std::size_t b) { return first_pixel(a) < first_pixel(b); });
  targets_.reserve(order.size());
  for (const std::size_t index : order) {
    const StarEstimator& estimator = estimators[index];
    Target target;
    target.index = index;
    target.offset = estimator.offset;
    target.known_background = estimator.known_background;
    target.flags = estimator.flags;
    target.aperture_begin = aperture_pixel_.size();
    target.background_begin = background_pixel_.size();
    for (std::size_t i = 0; i < estimator.terms.size(); ++i) {
      const EstimatorTerm& term = estimator.terms[i];
      if (i < estimator.aperture_terms) {
        aperture_pixel_.push_back(term.pixel);
        aperture_weight_.push_back(term.weight);
        target.weight_sum += static_cast<double>(term.weight);
      } else {
        ASTROID_CHECK_EQ(term.weight, estimator.terms.back().weight);
        background_pixel_.push_back(term.pixel);
      }
    }
    target.aperture_end = aperture_pixel_.size();
    target.background_end = background_pixel_.size();
    targets_.push_back(target);
  }
  find_stretch();
}

void EstimatorSet::find_stretch() {
  std::size_t end = 0;
  std::size_t longest = 1;
  for (Target& target : targets_) {
    std::size_t begin = std::numeric_limits<std::size_t>::max();
    for (const std::span<const std::uint32_t> pixels : {aperture_of(target), background_of(target)})
      for (const std::uint32_t pixel : pixels) {
        begin = std::min(begin, std::size_t{pixel});
        end = std::max(end, std::size_t{pixel} + 1);
      }
    target.pixel_end = end;
    if (begin < end) longest = std::max(longest, whole_steps(end) - begin);
  }
  stretch_ = std::bit_ceil(std::max(longest, kMaxBatch));
}

namespace {
/// Most frames of a faint field have no flagged pixel at all: one pass over the bytes saves a gather per term.
bool has_flags(const Frame& frame) {
  // Eight pixels at a time.
  const std::span<const std::uint8_t> flags = frame.flags.pixels();
  std::uint64_t any = 0;
  std::size_t i = 0;
  for (; i + sizeof(any) <= flags.size(); i += sizeof(any)) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags.data() + i, sizeof(eight));
    any |= eight;
  }
  for (; i < flags.size(); ++i) any |= flags[i];
  for (unsigned shift = 0; shift < 64; shift += 8)
    if (seen(static_cast<unsigned>(any >> shift) & 0xffU) != 0) return true;
  return false;
}
}  // namespace

void EstimatorSet::apply(const Frame& frame, std::span<double> flux, std::span<std::uint32_t> flags) const {
  ASTROID_CHECK_EQ(flux.size(), size());
  ASTROID_CHECK_EQ(flags.size(), size());
  const bool flagged = has_flags(frame);
  for (const Target& target : targets_) {
    const Measured measured = measure(frame, flagged, target);
    flux[target.index] = measured.flux;
    flags[target.index] = measured.flags;
  }
}

EstimatorSet::Measured EstimatorSet::measure(const Frame& frame, bool flagged, const Target& target) const {
  const float* counts = frame.pixels.pixels().data();
  const std::uint8_t* pixel_flags = frame.flags.pixels().data();
  Measured measured{std::numeric_limits<double>::quiet_NaN(), target.flags};
  const std::span<const std::uint32_t> pixel = aperture_of(target);
  if (pixel.empty()) return measured;
  const double sum = weighted_sum(pixel, {aperture_weight_.data() + target.aperture_begin, pixel.size()}, counts);
  if (flagged) measured.flags |= aperture_flags(any_flag(pixel, pixel_flags));
  if (!std::isfinite(sum)) {
    measured.flags |= measurement_flag::kBadPixel;
    return measured;
  }
  const std::span<const std::uint32_t> background = background_of(target);
  if (background.empty()) {
    measured.flux = gain_ * (sum - bias_ * target.weight_sum) - target.offset;
    return measured;
  }
  const bool spoilt = flagged && any_flag(background, pixel_flags) != 0;
  double level = spoilt ? 0.0 : plain_sum(background, counts);
  if (spoilt || !std::isfinite(level)) {
    measured.flux = gain_ * sum - background_without_spoilt(frame, target, measured.flags);
    return measured;
  }
  level /= static_cast<double>(background.size());
  measured.flux = gain_ * (sum - level * target.weight_sum) - target.offset;
  return measured;
}

void EstimatorSet::apply_one_by_one(std::span<const Frame> frames, const TakeFluxes& take) const {
  std::array<bool, kMaxBatch> flagged{};
  for (std::size_t f = 0; f < frames.size(); ++f) flagged[f] = has_flags(frames[f]);
  std::array<double, kMaxBatch> flux{};
  std::array<std::uint32_t, kMaxBatch> flags{};
  for (const Target& target : targets_) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const Measured measured = measure(frames[f], flagged[f], target);
      flux[f] = measured.flux;
      flags[f] = measured.flags;
    }
    take(target.index, std::span(flux).first(frames.size()), std::span(flags).first(frames.size()));
  }
}

void EstimatorSet::apply_batch(std::span<const Frame> frames, BatchScratch& scratch, const TakeFluxes& take) const {
  ASTROID_CHECK_LE(std::size_t{1}, frames.size());
  ASTROID_CHECK_LE(frames.size(), kMaxBatch);
  // Interleaving touches every pixel, which few stars in a large frame do not pay back.
  constexpr std::size_t kPixelsPerGather = 2;
  const std::size_t gathers = aperture_pixel_.size() + background_pixel_.size();
  if (frames.size() == 1 || kPixelsPerGather * gathers < frames.front().pixels.size()) {
    apply_one_by_one(frames, take);
    return;
  }
  const std::size_t pixels = frames.front().pixels.size();
  const std::size_t stride = detail::batch_stride(frames.size());
  std::array<const float*, kMaxBatch> counts_of{};
  std::array<const std::uint8_t*, kMaxBatch> flags_of{};
  for (std::size_t f = 0; f < frames.size(); ++f) {
    counts_of[f] = frames[f].pixels.pixels().data();
    flags_of[f] = frames[f].flags.pixels().data();
  }
  const std::span<const float* const> counts(counts_of.data(), frames.size());
  scratch.any_flag.resize(pixels);
  scratch.varying.resize(pixels);
  const bool flagged = detail::compare_flags({flags_of.data(), frames.size()}, scratch.any_flag, scratch.varying) != 0;
  scratch.interleaved.resize(stretch_ * stride / kMaxBatch);
  const detail::InterleavedFrames interleaved{scratch.interleaved.front().counts.data(), stretch_, stride};

  std::array<double, kMaxBatch> flux{};
  std::array<std::uint32_t, kMaxBatch> flags{};
  std::size_t ready = 0;  // pixels before it have been interleaved
  for (const Target& target : targets_) {
    flux.fill(std::numeric_limits<double>::quiet_NaN());
    flags.fill(target.flags);
    const std::span<const std::uint32_t> aperture = aperture_of(target);
    const std::span<const std::uint32_t> background = background_of(target);
    if (!aperture.empty()) {
      if (ready < target.pixel_end) {
        const std::size_t next = std::min(pixels, whole_steps(target.pixel_end));
        detail::interleave(counts, std::max(ready, next - std::min(next, stretch_)), next, interleaved);
        ready = next;
      }
      const detail::BatchTerms terms{.aperture = aperture,
                                     .weight = aperture_weight_.data() + target.aperture_begin,
                                     .background = background,
                                     .weight_sum = target.weight_sum,
                                     .offset = target.offset,
                                     .gain = gain_,
                                     .bias = bias_};
      bool measured = detail::batch_flux(interleaved, terms, flux.data());
      const bool spoilt = flagged && (any_flag(aperture, scratch.any_flag.data()) != 0 ||
                                      any_flag(background, scratch.any_flag.data()) != 0);
      if (spoilt) measured = measure_spoilt(interleaved, terms, measured, scratch, flux, flags);
      for (std::size_t f = 0; !measured && f < frames.size(); ++f) {
        const Measured single = measure(frames[f], flagged, target);
        flux[f] = single.flux;
        flags[f] = single.flags;
      }
    }
    take(target.index, {flux.data(), frames.size()}, {flags.data(), frames.size()});
  }
}

bool EstimatorSet::measure_spoilt(const detail::InterleavedFrames& frames, const detail::BatchTerms& terms, bool finite,
                                  BatchScratch& scratch, std::span<double, kMaxBatch> flux,
                                  std::span<std::uint32_t, kMaxBatch> flags) const {
  if (any_flag(terms.aperture, scratch.varying.data()) != 0) return false;
  if (any_flag(terms.background, scratch.varying.data()) != 0) return false;
  std::uint32_t more = aperture_flags(any_flag(terms.aperture, scratch.any_flag.data()));
  const std::uint8_t in_background = any_flag(terms.background, scratch.any_flag.data());
  if (in_background != 0) {
    scratch.good.clear();
    for (const std::uint32_t pixel : terms.background)
      if (seen(scratch.any_flag[pixel]) == 0) scratch.good.push_back(pixel);
    if (2 * scratch.good.size() < terms.background.size()) return false;
    more |=
        (aperture_flags(in_background) & measurement_flag::kSaturated) != 0 ? measurement_flag::kSpoiltBackground : 0;
    std::array<double, kMaxBatch> sum{};
    std::array<double, kMaxBatch> level{};
    detail::batch_sums(frames, terms, scratch.good, sum.data(), level.data());
    const auto good = static_cast<double>(scratch.good.size());
    finite = true;
    for (std::size_t f = 0; f < frames.stride; ++f) {
      finite = finite && std::isfinite(sum[f]) && std::isfinite(level[f]);
      flux[f] = gain_ * sum[f] - (gain_ * (level[f] / good) * terms.weight_sum + terms.offset);
    }
  }
  for (std::uint32_t& flag : flags) flag |= more;
  return finite;
}

double EstimatorSet::background_without_spoilt(const Frame& frame, const Target& target, std::uint32_t& flags) const {
  double sum = 0.0;
  std::size_t good = 0;
  bool saturated = false;
  for (std::size_t i = target.background_begin; i < target.background_end; ++i) {
    const std::uint32_t pixel = background_pixel_[i];
    const float counts = frame.pixels.pixels()[pixel];
    const std::uint8_t pixel_flags = frame.flags.pixels()[pixel];
    saturated = saturated || (aperture_flags(pixel_flags) & measurement_flag::kSaturated) != 0;
    if (seen(pixel_flags) != 0 || !std::isfinite(counts)) continue;
    sum += static_cast<double>(counts);
    ++good;
  }
  if (2 * good < target.background_end - target.background_begin) {
    flags |= measurement_flag::kNoBackground;
    return gain_ * bias_ * target.weight_sum + target.known_background;
  }
  // The offset holds the light that the model expects in the annulus: around a saturated star that is not what is
  // there.
  if (saturated) flags |= measurement_flag::kSpoiltBackground;
  return gain_ * (sum / static_cast<double>(good)) * target.weight_sum + target.offset;
}

}  // namespace astroid
