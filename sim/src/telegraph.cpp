#include "astroid/sim/telegraph.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

/// Steps back from `from` (included) to the last renewal at or before it: geometric, from one uniform. 0: it is `from`.
/// @param log_keep  ln(1 - renewal)
double steps_back(double uniform, double log_keep) {
  return std::floor(det::log(uniform) / log_keep);
}

double draw(const RandomStream& stream, const TelegraphPixel& pixel, std::uint32_t block, std::uint16_t number) {
  double uniform = 0.0;
  uniform_row(stream, {.x0 = pixel.x, .y = pixel.y, .exposure = block, .draw = number}, {&uniform, 1});
  return uniform;
}

}  // namespace

TelegraphProcess TelegraphProcess::of_times(const TelegraphStays& stays, double step) {
  return {.renewal = -det::expm1(-step * (1.0 / stays.low + 1.0 / stays.high)),
          .high = stays.high / (stays.low + stays.high)};
}

bool telegraph_is_high(const RandomStream& stream, const TelegraphPixel& pixel, const TelegraphProcess& process,
                       std::uint32_t step) {
  // A block of as many steps as renewals are apart, a power of two; the last one in it is found by the first draw.
  constexpr std::uint32_t kLongestBlock = 1U << 20U;
  std::uint32_t length = 1;
  while (length < kLongestBlock && static_cast<double>(length) * process.renewal < 1.0) length *= 2;
  const double log_keep = det::log1p(-process.renewal);
  // Draws of a block: pairs of the steps back to a renewal and the state that it leaves.
  for (std::uint32_t block = step / length;; --block) {
    const double end = static_cast<double>(block) * length + (length - 1.0);
    double renewed = end + 1.0;
    for (std::uint16_t number = 0; renewed > static_cast<double>(block) * length; number += 2) {
      renewed -= 1.0 + steps_back(draw(stream, pixel, block, number), log_keep);
      const bool in_block = renewed >= static_cast<double>(block) * length;
      // Every pixel is renewed at step 0: it was started long ago.
      const bool begins = !in_block && block == 0;
      if ((in_block && renewed <= static_cast<double>(step)) || begins)
        return draw(stream, pixel, block, static_cast<std::uint16_t>(number + 1)) < process.high;
    }
  }
}

}  // namespace astroid
