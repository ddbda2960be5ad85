#include "sub_pixel/deposit_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid::detail {

namespace {

constexpr double kAccuracy = 1e-15;
constexpr double kWidestBand = 0.42;  // cycles per node; closer to 0.5 the kernel would grow without limit

}  // namespace

DepositKernel::DepositKernel(double band) {
  ASTROID_CHECK_LE(band, kWidestBand);
  const double decay = kPi * det::sqrt(1.0 - 2.0 * band);  // of the error, for each node of the width
  width_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(-det::log(kAccuracy) / decay)), 4, kWidest);
  // Just below the first alias of the band: where the transform of the kernel stops decaying.
  constexpr double kMargin = 0.8;
  const double argument = static_cast<double>(width_) * (1.0 - band);
  shape_ = kPi * det::sqrt(argument * argument - kMargin);
  // I0(z) = sum of (z²/4)^k / k!², all terms positive.
  const double quarter = 0.25 * shape_ * shape_;
  double term = 1.0;
  centre_ = 0.0;
  constexpr double kNegligible = 1e-18;
  for (int k = 1; term > kNegligible * centre_; ++k) {
    centre_ += term;
    series_.push_back(term);
    term *= quarter / (static_cast<double>(k) * static_cast<double>(k));
  }
  for (double& coefficient : series_) coefficient /= centre_;
}

DepositKernel::Nodes DepositKernel::nodes(double x) const {
  const double half = 0.5 * static_cast<double>(width_);
  const double first = std::ceil(x - half);
  Nodes nodes{.first = static_cast<long>(first)};
  std::array<double, kWidest> u{};
  for (std::size_t i = 0; i < width_; ++i) {
    const double t = (first + static_cast<double>(i) - x) / half;
    u[i] = std::max(0.0, 1.0 - t * t);
  }
  // Horner's rule for all nodes side by side: none waits for another.
  for (auto c = series_.rbegin(); c != series_.rend(); ++c)
    for (std::size_t i = 0; i < kWidest; ++i) nodes.weights[i] = nodes.weights[i] * u[i] + *c;
  return nodes;
}

double DepositKernel::transform(double frequency) const {
  const double width = static_cast<double>(width_);
  const double z = kPi * width * frequency;
  const double root = det::sqrt(shape_ * shape_ - z * z);  // the band stays below the shape
  // width sinh(root) / (root I0(shape))
  return width * 0.5 * (det::exp(root) - det::exp(-root)) / (root * centre_);
}

}  // namespace astroid::detail
