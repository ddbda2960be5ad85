// Single rows of pixels, as convenience and as oracle: the kernels of pixel_noise.hpp on one row, and normals in double
// precision pixel by pixel.
#include <cstddef>

#include "astroid/core/distributions.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "normal_quantile.hpp"
#include "vector/pixel_counter.hpp"

namespace astroid {

namespace {

/// A row as an area.
class Row {
 public:
  Row(const PixelAddress& address, std::size_t size)
      : area_{address.x0, address.y, static_cast<int>(size), 1}, address_(address) {}
  [[nodiscard]] PixelPlaces places() const {
    return {.areas = {&area_, 1}, .exposure = address_.exposure, .read = address_.read, .draw = address_.draw};
  }

 private:
  Rectangle area_;
  PixelAddress address_;
};

}  // namespace

void uniform_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  pixel_uniforms(stream, Row(address, out.size()).places(), out);
}

void normal_row(const RandomStream& stream, const PixelAddress& address, std::span<double> out) {
  PixelAddress at = address;
  for (double& value : out) {
    value = normal::quantile(pixel_word(stream, at));
    ++at.x0;
  }
}

void poisson_row(const RandomStream& stream, const PixelAddress& address, std::span<const double> mean,
                 std::span<double> out) {
  pixel_poisson(stream, Row(address, out.size()).places(), mean, out);
}

}  // namespace astroid
