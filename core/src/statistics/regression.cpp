#include "astroid/core/statistics/regression.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {

Line fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights) {
  ASTROID_CHECK_EQ(x.size(), y.size());
  if (!weights.empty()) ASTROID_CHECK_EQ(x.size(), weights.size());
  const auto usable = [&](std::size_t i) { return std::isfinite(x[i]) && std::isfinite(y[i]); };
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  Line line;
  double sum = 0.0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!usable(i) || !(weight(i) > 0.0)) continue;
    ++line.used;
    sum += weight(i);
    mean_x += (x[i] - mean_x) * (weight(i) / sum);
    mean_y += (y[i] - mean_y) * (weight(i) / sum);
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!usable(i) || !(weight(i) > 0.0)) continue;
    xx += weight(i) * (x[i] - mean_x) * (x[i] - mean_x);
    xy += weight(i) * (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0.0)) return line;
  line.centre = mean_x;
  line.at_centre = mean_y;
  line.slope = xy / xx;
  if (line.used < 3) return line;
  double residual = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!usable(i) || !(weight(i) > 0.0)) continue;
    const double r = y[i] - line(x[i]);
    residual += weight(i) * r * r;
  }
  const double reduced = residual / static_cast<double>(line.used - 2);  // variance of a point of weight one
  line.at_centre_error = std::sqrt(reduced / sum);
  line.slope_error = std::sqrt(reduced / xx);
  line.scatter = std::sqrt(reduced * static_cast<double>(line.used) / sum);
  return line;
}

PolynomialTrend::PolynomialTrend(std::span<const double> x, std::span<const double> y, int degree) {
  ASTROID_CHECK_EQ(x.size(), y.size());
  std::vector<double> u;
  std::vector<double> residual;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    u.push_back(x[i]);
    residual.push_back(y[i]);
  }
  if (u.empty() || degree < 0) return;
  const auto [least, most] = std::minmax_element(u.begin(), u.end());
  centre_ = 0.5 * (*least + *most);
  if (*most > *least) per_half_range_ = 2.0 / (*most - *least);
  for (double& value : u) value = (value - centre_) * per_half_range_;

  std::vector<double> current(u.size(), 1.0);
  std::vector<double> before(u.size(), 0.0);
  double norm_before = 1.0;
  for (int k = 0; k <= degree; ++k) {
    double norm = 0.0;
    double moment = 0.0;
    double projection = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      norm += current[i] * current[i];
      moment += u[i] * current[i] * current[i];
      projection += residual[i] * current[i];
    }
    // A polynomial that vanishes on all points: there are no more different x than its degree.
    constexpr double kVanishing = 1e-20;
    if (!(norm > kVanishing * static_cast<double>(u.size()))) break;
    const Term term{projection / norm, moment / norm, k == 0 ? 0.0 : norm / norm_before};
    for (std::size_t i = 0; i < u.size(); ++i) {
      residual[i] -= term.coefficient * current[i];
      const double next = (u[i] - term.shift) * current[i] - term.previous * before[i];
      before[i] = current[i];
      current[i] = next;
    }
    norm_before = norm;
    terms_.push_back(term);
  }
}

double PolynomialTrend::operator()(double x) const {
  const double u = (x - centre_) * per_half_range_;
  double current = 1.0;
  double before = 0.0;
  double sum = 0.0;
  for (const Term& term : terms_) {
    sum += term.coefficient * current;
    const double next = (u - term.shift) * current - term.previous * before;
    before = current;
    current = next;
  }
  return terms_.empty() ? std::numeric_limits<double>::quiet_NaN() : sum;
}

}  // namespace astroid
