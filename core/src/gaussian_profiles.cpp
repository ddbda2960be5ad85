#include "gaussian_profiles.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

constexpr double kReach = 7.7;  // sigma: beyond lies less than 1.4e-14 of the star
constexpr double kRootTwo = 1.41421356237309504880168872420969808;
constexpr double kRootTwoPi = 2.50662827463100050241576528481104525;

/// Fraction between two edges at u0 < u1 sigma from the star, on the side where erfc does not cancel.
double fraction(double u0, double u1) {
  if (u0 >= 0.0) return 0.5 * (det::erfc(u0 / kRootTwo) - det::erfc(u1 / kRootTwo));
  if (u1 <= 0.0) return 0.5 * (det::erfc(-u1 / kRootTwo) - det::erfc(-u0 / kRootTwo));
  return 1.0 - 0.5 * (det::erfc(-u0 / kRootTwo) + det::erfc(u1 / kRootTwo));
}

/// He_k(u) phi(u) for k = 0 … kTerms - 2, the derivatives of the normal density up to sign.
std::array<double, GaussianProfiles::kTerms - 1> hermite_functions(double u) {
  std::array<double, GaussianProfiles::kTerms - 1> h{};
  h[0] = det::exp(-0.5 * u * u) / kRootTwoPi;
  h[1] = u * h[0];
  for (std::size_t k = 1; k + 1 < h.size(); ++k) h[k + 1] = u * h[k] - static_cast<double>(k) * h[k - 1];
  return h;
}

}  // namespace

GaussianProfiles::GaussianProfiles(double sigma) {
  // The first neglected term, (1 / (2 nodes sigma))^6 / 720 times at most 2.3 sigma^0, is then below 1e-14.
  constexpr double kNodesPerSigma = 38.0;
  nodes_ = 1;
  while (nodes_ * sigma < kNodesPerSigma) nodes_ *= 2;
  reach_ = static_cast<int>(std::ceil(kReach * sigma)) + 1;
  const int size = 2 * reach_ + 1;
  stride_ = static_cast<std::size_t>(size) + kPadding;
  rows_.assign(static_cast<std::size_t>(nodes_) * kTerms * stride_, 0.0);
  for (int node = 0; node < nodes_; ++node) {
    const double phase = (node + 0.5) / nodes_ - 0.5;
    double* const rows = &rows_[static_cast<std::size_t>(node) * kTerms * stride_];
    for (int i = 0; i < size; ++i) {
      const double lower = (i - reach_ - 0.5 - phase) / sigma;
      const double upper = (i - reach_ + 0.5 - phase) / sigma;
      rows[i] = fraction(lower, upper);
      const auto below = hermite_functions(lower);
      const auto above = hermite_functions(upper);
      double scale = 1.0;  // 1 / (sigma^k k!)
      for (std::size_t k = 1; k < kTerms; ++k) {
        scale /= sigma * static_cast<double>(k);
        rows[k * stride_ + static_cast<std::size_t>(i)] = scale * (below[k - 1] - above[k - 1]);
      }
    }
  }
}

GaussianProfiles::Phase GaussianProfiles::phase(double position) const {
  const double pixel = std::floor(position + 0.5);
  const double from_edge = position - pixel + 0.5;  // 0 … 1
  const int node = std::min(nodes_ - 1, static_cast<int>(from_edge * nodes_));
  Phase phase;
  phase.axis.rows = &rows_[static_cast<std::size_t>(node) * kTerms * stride_];
  phase.axis.first = static_cast<int>(pixel) - reach_;
  phase.axis.size = 2 * reach_ + 1;
  phase.offset = from_edge - (node + 0.5) / nodes_;
  return phase;
}

GaussianProfiles::Axis GaussianProfiles::axis(double position, double variance) const {
  Phase p = phase(position);
  const double d = p.offset;
  std::array<double, kTerms>& w = p.axis.weights;
  w[0] = 1.0;
  for (std::size_t k = 1; k < kTerms; ++k) w[k] = w[k - 1] * d;
  if (variance == 0.0) return p.axis;
  // The mean over the motion adds variance/2 d²/dx² + variance²/8 d⁴/dx⁴ (the heat equation).
  const double second = 0.5 * variance;
  const double fourth = 0.5 * second * second;
  const std::array<double, kTerms> powers = w;
  for (std::size_t k = 2; k < kTerms; ++k) w[k] += second * static_cast<double>(k * (k - 1)) * powers[k - 2];
  for (std::size_t k = 4; k < kTerms; ++k)
    w[k] += fourth * static_cast<double>(k * (k - 1) * (k - 2) * (k - 3)) * powers[k - 4];
  return p.axis;
}

GaussianProfiles::Axis GaussianProfiles::slope(double position) const {
  Phase p = phase(position);
  double power = 1.0;
  for (std::size_t k = 1; k < kTerms; ++k) {
    p.axis.weights[k] = static_cast<double>(k) * power;
    power *= p.offset;
  }
  return p.axis;
}

}  // namespace astroid::detail
