// Brighter-fatter against the sum over all pixels as the paper writes it, pixel by pixel.
#include "astroid/sim/brighter_fatter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace astroid {
namespace {

using Electrons2d = Image<double, unit::SampledElectrons>;

/// E1 by summing the integral in steps of ln t.
double exponential_integral(double x) {
  static std::map<double, double> known;
  if (const auto found = known.find(x); found != known.end()) return found->second;
  double& sum = known[x];
  constexpr double kStep = 1e-4;
  for (double u = std::log(x) + 0.5 * kStep; u < std::log(60.0); u += kStep) sum += std::exp(-std::exp(u)) * kStep;
  return sum;
}

/// Change of a pixel: the sum over its four boundaries X and all pixels i of a_i^X Q_i (Q_0 + Q_X) / 4, where a is
/// positive if electron and pixel 0 are on different sides of the boundary.
double change(const Electrons2d& image, int x, int y, double serial, double parallel, double decay, int range) {
  const auto charge = [&](int i, int j) { return image.area().contains(i, j) ? image.at(i, j) : 0.0; };
  double total = 0.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
    if (!image.area().contains(x + dx, y + dy)) continue;
    double sum = 0.0;
    for (int j = y - range; j <= y + range; ++j)
      for (int i = x - range; i <= x + range; ++i) {
        const double along = dx != 0 ? (i - x) * dx - 0.5 : (j - y) * dy - 0.5;  // from the boundary, outwards
        const double across = dx != 0 ? j - y : i - x;
        if (std::abs(along) > range || std::abs(across) >= range) continue;
        const double r = std::hypot(along, across);
        const double a = (dx != 0 ? serial : parallel) * exponential_integral(decay * r) /
                         exponential_integral(0.5 * decay) * along / r;
        sum += a * charge(i, j);
      }
    total += sum * (image.at(x, y) + image.at(x + dx, y + dy)) / 4.0;
  }
  return total;
}

TEST(BrighterFatter, IsTheSumOverAllPixels) {
  for (const int range : {1, 2, 4}) {
    Electrons2d image(11, 9);
    std::size_t i = 0;
    for (double& pixel : image.pixels()) pixel = static_cast<double>((++i * 2654435761U) % 80000U);
    const Electrons2d before = image.clone();
    EXPECT_EQ(brighter_fatter(image.view(), BoundaryShifts({3e-7, 5e-7, 0.6, range})), 0);
    double largest = 0.0;
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 11; ++x) {
        const double expected = change(before, x, y, 3e-7, 5e-7, 0.6, range);
        largest = std::max(largest, std::abs(expected));
        // The integral of the oracle is good to 1e-8.
        EXPECT_NEAR(image.at(x, y) - before.at(x, y), expected, 1e-4) << x << ' ' << y;
      }
    EXPECT_GT(largest, 100.0);
  }
}

}  // namespace
}  // namespace astroid
