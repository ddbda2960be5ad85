#include "astroid/sim/attitude_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr std::size_t kAxes = 4;
constexpr std::size_t kTime = 3;

std::array<double, kAxes> axes(const Attitude& a, double time) {
  return {a.yaw, a.pitch, a.roll, time};
}

/// Points of an axis in units of the scale, in the order in which higher powers take them: a Leja sequence of [-1, 1].
constexpr double kLejaPoints[] = {0.0, 1.0, -1.0, 0.57735026918962576, -0.65871, 0.83924, -0.87004};

double power(double base, int exponent) {
  double value = 1.0;
  for (int i = 0; i < exponent; ++i) value *= base;
  return value;
}

double term(const AttitudePowers& powers, const std::array<double, kAxes>& x) {
  double value = 1.0;
  for (std::size_t axis = 0; axis < kAxes; ++axis) value *= power(x[axis], powers[axis]);
  return value;
}

/// The derivative of the order that the powers of the attitude add up to, and by time as often as its power says:
/// Faà di Bruno's formula for a displacement px (e^(rate t) - 1), whose derivatives are the largest that there may be.
double derivative_of(std::span<const double> derivatives, const AttitudePowers& powers, const SlowMotion& slow) {
  std::size_t order = 0;
  for (std::size_t axis = 0; axis < kTime; ++axis) order += static_cast<std::size_t>(powers[axis]);
  const auto l = static_cast<std::size_t>(powers[kTime]);
  if (l == 0) return derivatives[order];
  std::vector<double> stirling(l + 1, 0.0);  // S(l, q), from S(0, 0) on
  stirling[0] = 1.0;
  for (std::size_t row = 1; row <= l; ++row) {
    for (std::size_t q = row; q > 0; --q) stirling[q] = static_cast<double>(q) * stirling[q] + stirling[q - 1];
    stirling[0] = 0.0;
  }
  double sum = 0.0;
  for (std::size_t q = l; q > 0; --q) sum = (sum + stirling[q] * derivatives[order + q]) * slow.px;
  return power(slow.rate, powers[kTime]) * sum;
}

bool holds(const std::vector<AttitudePowers>& terms, const AttitudePowers& powers) {
  return std::ranges::find(terms, powers) != terms.end();
}

/// Whether every term with one power less is there.
bool may_follow(const std::vector<AttitudePowers>& terms, const AttitudePowers& powers) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    AttitudePowers lower = powers;
    if (--lower[axis] >= 0 && !holds(terms, lower)) return false;
  }
  return true;
}

}  // namespace

std::vector<AttitudePowers> choose_attitude_terms(std::span<const double> derivatives, const AttitudeReach& reach,
                                                  double allowed, std::size_t most, double& left_out) {
  struct Candidate {
    AttitudePowers powers;
    double bound;
  };
  constexpr double kFactorials[] = {1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0};
  const int highest = static_cast<int>(std::min(derivatives.size(), std::size(kFactorials))) - 1;
  const std::array<double, kAxes> r{reach.yaw, reach.pitch, reach.roll, 1.0};
  const int highest_of_time = reach.slow.px > 0.0 ? highest : 0;
  std::vector<Candidate> candidates;
  std::array<double, std::size(kFactorials)> of_order{};
  left_out = 0.0;
  for (int i = 0; i <= highest; ++i)
    for (int j = 0; i + j <= highest; ++j)
      for (int k = 0; i + j + k <= highest; ++k)
        for (int l = 0; i + j + k + l <= highest && l <= highest_of_time; ++l) {
          const AttitudePowers powers{i, j, k, l};
          double bound = derivative_of(derivatives, powers, reach.slow) * term(powers, r);
          for (const int p : powers) bound /= kFactorials[p];
          // A line through the points 0 and 1 is off by twice Taylor's term at -1, where times go and jitter seldom
          // does.
          if (l == 2) bound *= 2.0;
          if (i + j + k + l == 0 || !(bound > 0.0)) continue;
          candidates.push_back({powers, bound});
          const int order = i + j + k + l;
          of_order[static_cast<std::size_t>(order)] += bound;
          left_out += bound;
        }
  // Orders whose derivatives are not known, if they go on falling as the last ones did.
  const auto last = static_cast<std::size_t>(highest);
  double beyond = 0.0;
  if (last >= 2 && of_order[last] > 0.0) {
    const double fall = det::sqrt(of_order[last] / of_order[last - 2]);
    if (!(fall < 1.0)) return {};
    beyond = of_order[last] * fall / (1.0 - fall);
  }
  left_out += beyond;
  std::vector<AttitudePowers> terms{{0, 0, 0, 0}};
  while (left_out > allowed) {
    if (terms.size() == most) return {};
    auto best = candidates.end();
    for (auto c = candidates.begin(); c != candidates.end(); ++c)
      if ((best == candidates.end() || c->bound > best->bound) && may_follow(terms, c->powers) &&
          *std::ranges::max_element(c->powers) < static_cast<int>(std::size(kLejaPoints)))
        best = c;
    if (best == candidates.end()) return {};
    terms.push_back(best->powers);
    candidates.erase(best);
    left_out = beyond;
    for (const Candidate& c : candidates) left_out += c.bound;
  }
  return terms;
}

Attitude cell_centre(const AttitudePolynomial& polynomial, const Attitude& attitude) {
  const auto centre = [](double value, double scale) {
    return scale > 0.0 ? 2.0 * scale * std::floor(value / (2.0 * scale) + 0.5) : 0.0;
  };
  return {centre(attitude.yaw, polynomial.scale.yaw), centre(attitude.pitch, polynomial.scale.pitch),
          centre(attitude.roll, polynomial.scale.roll)};
}

int AttitudePolynomial::highest_power_of_time() const {
  int highest = 0;
  for (const AttitudePowers& p : terms) highest = std::max(highest, p[kTime]);
  return highest;
}

std::vector<MotionPoint> interpolation_points(const AttitudePolynomial& polynomial, const Attitude& centre) {
  std::vector<MotionPoint> points;
  for (const AttitudePowers& p : polynomial.terms)
    points.push_back({.attitude = {centre.yaw + polynomial.scale.yaw * kLejaPoints[p[0]],
                                   centre.pitch + polynomial.scale.pitch * kLejaPoints[p[1]],
                                   centre.roll + polynomial.scale.roll * kLejaPoints[p[2]]},
                      .time = kLejaPoints[p[kTime]]});
  return points;
}

std::vector<double> coefficients_from_values(const AttitudePolynomial& polynomial) {
  // The inverse of the matrix of terms at points, by Gauss-Jordan elimination with pivots; it is small.
  const std::size_t n = polynomial.terms.size();
  std::vector<double> a(n * n);
  std::vector<double> inverse(n * n, 0.0);
  for (std::size_t point = 0; point < n; ++point) {
    const AttitudePowers& p = polynomial.terms[point];
    const std::array<double, kAxes> x{kLejaPoints[p[0]], kLejaPoints[p[1]], kLejaPoints[p[2]], kLejaPoints[p[kTime]]};
    for (std::size_t t = 0; t < n; ++t) a[point * n + t] = term(polynomial.terms[t], x);
    inverse[point * n + point] = 1.0;
  }
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row)
      if (std::fabs(a[row * n + column]) > std::fabs(a[pivot * n + column])) pivot = row;
    ASTROID_CHECK_LT(0.0, std::fabs(a[pivot * n + column]));
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(a[pivot * n + k], a[column * n + k]);
      std::swap(inverse[pivot * n + k], inverse[column * n + k]);
    }
    const double scale = 1.0 / a[column * n + column];
    for (std::size_t k = 0; k < n; ++k) {
      a[column * n + k] *= scale;
      inverse[column * n + k] *= scale;
    }
    for (std::size_t row = 0; row < n; ++row) {
      const double factor = a[row * n + column];
      if (row == column || factor == 0.0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        a[row * n + k] -= factor * a[column * n + k];
        inverse[row * n + k] -= factor * inverse[column * n + k];
      }
    }
  }
  return inverse;
}

std::vector<double> mean_of_terms(const AttitudePolynomial& polynomial, const Attitude& centre,
                                  std::span<const Attitude> attitudes, double time) {
  std::vector<double> mean(polynomial.terms.size(), 0.0);
  const std::array<double, kAxes> c = axes(centre, 0.0);
  const std::array<double, kAxes> scale = axes(polynomial.scale, 1.0);
  for (const Attitude& attitude : attitudes) {
    std::array<double, kAxes> x = axes(attitude, time);
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      x[axis] = scale[axis] > 0.0 ? (x[axis] - c[axis]) / scale[axis] : 0.0;
    for (std::size_t t = 0; t < mean.size(); ++t) mean[t] += term(polynomial.terms[t], x);
  }
  for (double& value : mean) value /= static_cast<double>(attitudes.size());
  return mean;
}

}  // namespace astroid
