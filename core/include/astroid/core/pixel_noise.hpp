// Noise of many pixels at once: the kernels that the time of a simulation is spent in.
//
// Each kernel runs on the widest vectors of the processor (vector_target.hpp) and has a plain scalar twin in
// namespace reference, with the same bits. Only + - * / sqrt, floor, comparisons and integers are used, never a fused
// multiply-add (docs/decisions/0002-determinism.md). @thread safe, no state, no allocation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "astroid/core/distributions.hpp"

namespace astroid {

/// Rows of equally many pixels, one after the other in memory: rows y, y + 1, ... of columns x0, x0 + 1, ... of
/// `address`. The number of rows must divide the number of pixels.
struct PixelRows {
  PixelAddress address;  ///< of the first pixel
  std::size_t rows = 1;
};

/// The random words of pixels (docs/random-numbers.md).
void pixel_words(const RandomStream& stream, const PixelRows& pixels, std::span<std::uint32_t> words);

/// Uniforms in (0, 1), 32 bits: uniform_from() of the words.
void pixel_uniforms(const RandomStream& stream, const PixelRows& pixels, std::span<double> uniforms);

/// Standard normals in single precision, from -6.34 to 6.34.
/// @accuracy  within 1e-7 + 8e-7 |z| of the exact quantile z of the word (test: PixelNormal.IsTheQuantileOfItsWord):
/// the
///            distribution function is off by less than 3e-7 anywhere.
/// @complexity some 45 operations a pixel beside Philox (bench: BM_PixelNoise)  @source Giles2012, with our own fits
void pixel_normals(const RandomStream& stream, const PixelRows& pixels, std::span<float> normals);

/// values += rms * normal, the normals of pixel_normals().
void add_pixel_normals(const RandomStream& stream, const PixelRows& pixels, double rms, std::span<double> values);

/// Poisson counts of the given means: exactly poisson_quantile() of the pixel's word of `draw` and, where that leaves
/// the count open, of `draw + 1` for the low half.
/// @param mean    e-, 0 .. 1e15.  @param counts  [out] must not overlap `mean`.
/// @throws BugError when a mean is negative, NaN or above 1e15, when the spans differ in size or draw is 65535.
/// @source Giles2016 in single precision; see poisson_quantile() for what decides close to a step.
void pixel_poisson(const RandomStream& stream, const PixelRows& pixels, std::span<const double> mean,
                   std::span<double> counts);

/// What an ADC makes of counts: clamped to 0 .. top, rounded half to even.
/// @param flags  [in,out] gains pixel_flag::kAdcSaturated where clipped, kBad where the value is not a number (then 0).
/// @returns the number of pixels clipped.
std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags);

/// The plain versions, pixel by pixel: what the kernels are tested against.
namespace reference {
float pixel_normal(std::uint32_t word);
void pixel_words(const RandomStream& stream, const PixelRows& pixels, std::span<std::uint32_t> words);
void pixel_uniforms(const RandomStream& stream, const PixelRows& pixels, std::span<double> uniforms);
void pixel_normals(const RandomStream& stream, const PixelRows& pixels, std::span<float> normals);
void add_pixel_normals(const RandomStream& stream, const PixelRows& pixels, double rms, std::span<double> values);
void pixel_poisson(const RandomStream& stream, const PixelRows& pixels, std::span<const double> mean,
                   std::span<double> counts);
std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags);
}  // namespace reference

}  // namespace astroid
