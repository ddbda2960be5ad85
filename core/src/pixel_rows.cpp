// Single rows of pixels, as convenience and as oracle: the kernels of pixel_noise.hpp on one row, and normals in double
// precision pixel by pixel.
#include <cstddef>

#include "astroid/core/distributions.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "normal_quantile.hpp"
#include "vector/pixel_counter.hpp"

namespace astroid {

void uniform_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  pixel_uniforms(stream, {.address = address}, out);
}

void normal_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = normal::quantile(pixel_word(stream, pixel_at({.address = address}, out.size(), i)));
}

void poisson_row(const RandomStream& stream, const PixelAddress& address, std::span<const double> mean,
                 std::span<double> out) {
  pixel_poisson(stream, {.address = address}, mean, out);
}

}  // namespace astroid
