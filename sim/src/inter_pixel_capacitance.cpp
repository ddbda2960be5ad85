#include "astroid/sim/inter_pixel_capacitance.hpp"

#include <cstddef>
#include <span>

#include "astroid/core/error.hpp"

namespace astroid {

namespace {

/// Adds what a row gains from the row above or below it.
void couple_rows(std::span<const double> own, std::span<const double> other, const InterPixelCoupling& coupling,
                 std::span<double> signal) {
  const std::size_t n = own.size();
  for (std::size_t x = 0; x < n; ++x) signal[x] += coupling.side * (other[x] - own[x]);
  for (std::size_t x = 1; x < n; ++x) signal[x] += coupling.corner * (other[x - 1] - own[x]);
  for (std::size_t x = 0; x + 1 < n; ++x) signal[x] += coupling.corner * (other[x + 1] - own[x]);
}

}  // namespace

void couple_pixels(const ImageView<const double, unit::SampledElectrons>& charge, const InterPixelCoupling& coupling,
                   const ImageView<double, unit::SampledElectrons>& signal) {
  const Rectangle& area = charge.area();
  ASTROID_CHECK_EQ(signal.area() == area, true);
  const auto n = static_cast<std::size_t>(area.nx);
  // Always the same terms in the same order, so that a pixel does not depend on which rows are computed with it.
  for (int y = area.y0; y < area.y1(); ++y) {
    const std::span<const double> own = charge.row(y);
    const std::span<double> out = signal.row(y);
    for (std::size_t x = 0; x < n; ++x) out[x] = own[x];
    for (std::size_t x = 1; x < n; ++x) out[x] += coupling.side * (own[x - 1] - own[x]);
    for (std::size_t x = 0; x + 1 < n; ++x) out[x] += coupling.side * (own[x + 1] - own[x]);
    if (y > area.y0) couple_rows(own, charge.row(y - 1), coupling, out);
    if (y + 1 < area.y1()) couple_rows(own, charge.row(y + 1), coupling, out);
  }
}

}  // namespace astroid
