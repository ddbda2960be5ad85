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
#include "astroid/core/image.hpp"

namespace astroid {

/// Which random number of which pixels: those of rectangles one after the other in memory, each row by row. Large
/// rectangles and many small ones cost the same by the pixel. Effects of scope `static` use exposure 0.
struct PixelPlaces {
  std::span<const Rectangle> areas;  ///< detector pixels
  std::uint32_t exposure = 0;
  std::uint16_t read = 0;
  std::uint16_t draw = 0;  ///< which random number of a pixel within the effect
};

/// The random words of pixels (docs/random-numbers.md).
/// @throws BugError, as all of them do, when the areas have another number of pixels than the span.
void pixel_words(const RandomStream& stream, const PixelPlaces& pixels, std::span<std::uint32_t> words);

/// Uniforms in (0, 1), 32 bits: uniform_from() of the words.
void pixel_uniforms(const RandomStream& stream, const PixelPlaces& pixels, std::span<double> uniforms);

/// Standard normals in single precision, from -6.34 to 6.34.
/// @accuracy  within 1e-7 + 8e-7 |z| of the exact quantile z of the word (test: PixelNormal.IsTheQuantileOfItsWord):
/// the
///            distribution function is off by less than 3e-7 anywhere.
/// @complexity some 45 operations a pixel beside Philox (bench: BM_PixelNoise)  @source Giles2012, with our own fits
void pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, std::span<float> normals);

/// values += rms * normal, the normals of pixel_normals().
void add_pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, double rms, std::span<double> values);

/// Poisson counts of the given means: exactly poisson_quantile() of the pixel's word of `draw` and, where that leaves
/// the count open, of `draw + 1` for the low half.
/// @param mean    e-, 0 .. 1e15.  @param counts  [out] must not overlap `mean`.
/// @throws BugError when a mean is negative, NaN or above 1e15, when the spans differ in size or draw is 65535.
/// @source Giles2016 in single precision; see poisson_quantile() for what decides close to a step.
void pixel_poisson(const RandomStream& stream, const PixelPlaces& pixels, std::span<const double> mean,
                   std::span<double> counts);

/// What an ADC makes of counts: clamped to 0 .. top, rounded half to even.
/// @param flags  [in,out] gains pixel_flag::kAdcSaturated where clipped, kBad where the value is not a number (then 0).
/// @returns the number of pixels clipped.
std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags);

/// The plain versions, pixel by pixel: what the kernels are tested against.
namespace reference {
float pixel_normal(std::uint32_t word);
void pixel_words(const RandomStream& stream, const PixelPlaces& pixels, std::span<std::uint32_t> words);
void pixel_uniforms(const RandomStream& stream, const PixelPlaces& pixels, std::span<double> uniforms);
void pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, std::span<float> normals);
void add_pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, double rms, std::span<double> values);
void pixel_poisson(const RandomStream& stream, const PixelPlaces& pixels, std::span<const double> mean,
                   std::span<double> counts);
std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags);
}  // namespace reference

}  // namespace astroid
