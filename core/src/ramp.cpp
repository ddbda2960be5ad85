#include "astroid/core/ramp.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {

RampWeights::RampWeights(int intervals, double photons_per_read_noise)
    : coupling_(1.0 / (photons_per_read_noise + 2.0)) {
  ASTROID_CHECK_LE(1, intervals);
  ASTROID_CHECK_LE(0.0, photons_per_read_noise);
  // The covariance divided by its diagonal: 1, and -coupling beside it. Its pivots lie between 1/2 and 1, and nothing
  // is subtracted from anything nearly equal, so every φ from 0 to infinity is as accurate as any other.
  double pivot = 1.0;
  double ones = 0.0;  // (L⁻¹ 1)_i
  double information = 0.0;
  for (int i = 0; i < intervals; ++i) {
    const double carry = i == 0 ? 0.0 : coupling_ / pivot;
    pivot = 1.0 - carry * coupling_;
    ones = 1.0 + carry * ones;
    const double share = ones / pivot;
    information += ones * share;
    carry_.push_back(carry);
    share_.push_back(share);
    information_.push_back(information);
  }
}

std::vector<double> RampWeights::weights(int m) const {
  // Lᵀw = a, from the last increment back.
  std::vector<double> w(share_.begin(), share_.begin() + m);
  for (int i = m - 2; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    w[at] += carry_[at + 1] * w[at + 1];
  }
  const double scale = static_cast<double>(intervals()) / information(m);
  for (double& weight : w) weight *= scale;
  return w;
}

RampVariance RampWeights::variance(int m) const {
  RampVariance sum{0.0, 0.0};
  double previous = 0.0;
  for (const double w : weights(m)) {
    sum.photon += w * w;
    sum.readout += (w - previous) * (w - previous);
    previous = w;
  }
  sum.photon /= static_cast<double>(intervals());
  sum.readout += previous * previous;
  return sum;
}

double photons_per_read_noise(RampFit fit, double electrons, int intervals, double read_variance) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (fit) {
    case RampFit::kDifference:
      return kInfinity;
    case RampFit::kLeastSquares:
      return 0.0;
    case RampFit::kOptimal:
      if (!(electrons > 0.0)) return 0.0;
      return read_variance > 0.0 ? electrons / static_cast<double>(intervals) / read_variance : kInfinity;
  }
  throw BugError("unknown ramp fit");
}

int RampNoise::usable_intervals(double electrons) const {
  if (reads <= 1) return electrons < full_well ? 1 : 0;
  const int intervals = reads - 1;
  if (electrons < full_well) return intervals;
  // Read i holds electrons i / intervals.
  const double below = std::ceil(full_well / electrons * intervals) - 1.0;
  return std::clamp(static_cast<int>(below), 0, intervals);
}

RampVariance RampNoise::variance(double electrons, double read_variance) const {
  if (reads <= 1) return {};
  const int intervals = reads - 1;
  const RampWeights weights(intervals, photons_per_read_noise(fit, electrons, intervals, read_variance));
  return weights.variance(std::max(1, usable_intervals(electrons)));
}

}  // namespace astroid
