// The arithmetic of measuring several frames at once: vector code over the frames, written once for all processors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace astroid::detail {

/// A stretch of the pixels of a batch of frames: counts of frame f in pixel p at [(p % pixels) * stride + f].
struct InterleavedFrames {
  float* counts = nullptr;  ///< shape (pixels, stride), aligned to 64 bytes
  std::size_t pixels = 0;   ///< a power of two
  std::size_t stride = 0;   ///< 4, 8 or 16: not less than the number of frames
};

/// The smallest stride that holds so many frames (1 … 16).
[[nodiscard]] constexpr std::size_t batch_stride(std::size_t frames) {
  return frames <= 4 ? 4 : frames <= 8 ? 8 : 16;
}

/// What batch_flux() sums for one target.
struct BatchTerms {
  std::span<const std::uint32_t> aperture;    ///< pixels, at least one
  const float* weight = nullptr;              ///< of each pixel of the aperture
  std::span<const std::uint32_t> background;  ///< pixels; empty: the bias stands in for their mean
  double weight_sum = 0.0;                    ///< of the aperture
  double offset = 0.0;                        ///< e-
  double gain = 1.0;                          ///< e-/ADU
  double bias = 0.0;                          ///< ADU
};

/// Copies pixels first … last-1 of every frame to their place among the interleaved ones; places beyond the last frame
/// get the first frame's counts.
/// @param frames  counts of each frame, at most into.stride.
void interleave(std::span<const float* const> frames, std::size_t first, std::size_t last,
                const InterleavedFrames& into);

/// gain * (sum of weight * counts - weight_sum * mean of background) - offset, for every frame.
///
/// Every frame's sums are taken in the order of EstimatorSet::apply(): the same bits on every processor.
/// @param flux  [out] shape (frames.stride), e- per exposure.
/// @returns     whether all of them are finite.
bool batch_flux(const InterleavedFrames& frames, const BatchTerms& terms, double* flux);

/// The sums of a target whose background has pixels to be left out, for every frame: as EstimatorSet takes them one
/// frame at a time, the background in one running sum.
/// @param good        pixels of the background that count.
/// @param aperture    [out] shape (frames.stride), sum of weight * counts, ADU.
/// @param background  [out] shape (frames.stride), sum of counts in `good`, ADU.
void batch_sums(const InterleavedFrames& frames, const BatchTerms& terms, std::span<const std::uint32_t> good,
                double* aperture, double* background);

/// Finds the flags that any frame has, pixel by pixel, and those that some frames have and others have not.
/// @param any, varying  [out] shape (pixels).
/// @returns             the flags of all pixels.
std::uint8_t compare_flags(std::span<const std::uint8_t* const> frames, std::span<std::uint8_t> any,
                           std::span<std::uint8_t> varying);

}  // namespace astroid::detail
