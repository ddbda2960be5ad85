// What a library of phases is asked for holds beside brighter neighbours too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

double light(const PixelPsf& psf, PixelPosition star, Rectangle square) {
  std::vector<double> fractions(square.size());
  psf.integrate(star, square, fractions);
  return std::accumulate(fractions.begin(), fractions.end(), 0.0);
}

// A target and a star that is up to a thousand times as bright, at any distance: the light of both in the squares of 2
// and 3 px about the target, against the exact Gaussian.
TEST(PrfPsf, IsAsGoodAsItIsAskedForBesideBrighterNeighbours) {
  constexpr double kAccuracy = 1e-6;
  constexpr int kPairs = 20000;
  for (const double sigma : {0.5, 0.7, 1.1}) {
    const auto exact = make_gaussian_psf(sigma);
    // The table errs by a share of the star that is a thousand times as bright.
    const auto prf = make_prf_psf(make_gaussian_table(sigma, 1e-4 * kAccuracy), 0.9 * kAccuracy);
    EXPECT_LE(prf->approximation_error(), kAccuracy);
    const RandomStream stream = make_stream(20270102, StreamId{0}, 0, 0);
    double worst = 0.0;
    for (std::uint64_t pair = 0; pair < kPairs; ++pair) {
      const auto dice = [&](std::uint32_t axis, double from, double to) {
        return from + (to - from) * uniform_at_step(stream, {.step = pair, .axis = axis});
      };
      const PixelPosition target{dice(0, 0.0, 1.0), dice(1, 0.0, 1.0)};
      const double distance = dice(2, 1.0, 6.0);
      const double angle = dice(3, 0.0, 6.283185307179586);
      const PixelPosition neighbour{target.x + distance * std::cos(angle), target.y + distance * std::sin(angle)};
      const double brightness = std::pow(10.0, dice(4, 0.0, 3.0));
      for (const int n : {2, 3}) {
        const int first = n == 3 ? -1 : 0;
        const Rectangle square{static_cast<int>(std::lround(target.x)) * (n == 3 ? 1 : 0) + first,
                               static_cast<int>(std::lround(target.y)) * (n == 3 ? 1 : 0) + first, n, n};
        const double truth = light(*exact, target, square) + brightness * light(*exact, neighbour, square);
        const double made = light(*prf, target, square) + brightness * light(*prf, neighbour, square);
        worst = std::max(worst, std::abs(made / truth - 1.0));
      }
    }
    std::printf("sigma %g: %.2g ppm, %s\n", sigma, 1e6 * worst, prf->description().c_str());
    EXPECT_LT(worst, kAccuracy) << sigma;
  }
}

}  // namespace
}  // namespace astroid
