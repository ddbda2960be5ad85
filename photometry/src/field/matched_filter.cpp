#include "field/matched_filter.hpp"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

namespace astroid::detail {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<float, 4>;

std::vector<double> squares_of(std::span<const double> kernel) {
  std::vector<double> squares(kernel.begin(), kernel.end());
  for (double& k : squares) k *= k;
  return squares;
}

// out[x] = sum_k weight[k] in[x + k step], for n values; reads up to 3 beyond. Along a row the step is 1, down a column
// the stride of the plane.
void filter_line(const float* in, std::size_t step, std::span<const float> weights, std::span<float> out, bool add) {
  const Four d;
  for (std::size_t x = 0; x < out.size(); x += 4) {
    auto sum = add ? hn::LoadU(d, out.data() + x) : hn::Zero(d);
    for (std::size_t k = 0; k < weights.size(); ++k)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, in + k * step + x)));
    hn::StoreU(sum, d, out.data() + x);
  }
}

// Where a parabola through three values has its top, within half a step.
double top_of(float left, float middle, float right) {
  const double curvature = static_cast<double>(left) - 2.0 * static_cast<double>(middle) + static_cast<double>(right);
  if (!(curvature < 0.0)) return 0.0;
  return std::clamp(0.5 * (static_cast<double>(left) - static_cast<double>(right)) / curvature, -0.5, 0.5);
}

}  // namespace

SeparableKernel::SeparableKernel(std::span<const double> kernel, double tolerance) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(kernel.size()))));
  half_ = static_cast<int>(side / 2);
  std::vector<double> rest(kernel.begin(), kernel.end());
  double total = 0.0;
  for (const double k : rest) total += k * k;
  double left = total;
  // The largest singular vectors one after the other, by power iteration from the row of the largest element.
  while (terms_.size() < side && left > tolerance * tolerance * total) {
    std::size_t start = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (std::abs(rest[i]) > std::abs(rest[start])) start = i;
    const auto row_begin = rest.begin() + static_cast<std::ptrdiff_t>(start / side * side);
    std::vector<double> row(row_begin, row_begin + static_cast<std::ptrdiff_t>(side));
    std::vector<double> column(side);
    constexpr int kIterations = 30;
    for (int n = 0; n < kIterations; ++n) {
      double norm = 0.0;
      for (const double r : row) norm += r * r;
      for (std::size_t j = 0; j < side; ++j) {
        column[j] = 0.0;
        for (std::size_t i = 0; i < side; ++i) column[j] += rest[j * side + i] * row[i] / norm;
      }
      norm = 0.0;
      for (const double c : column) norm += c * c;
      if (!(norm > 0.0)) break;
      for (std::size_t i = 0; i < side; ++i) {
        row[i] = 0.0;
        for (std::size_t j = 0; j < side; ++j) row[i] += rest[j * side + i] * column[j] / norm;
      }
    }
    left = 0.0;
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t i = 0; i < side; ++i) {
        double& r = rest[j * side + i];
        r -= column[j] * row[i];
        left += r * r;
      }
    terms_.push_back({std::vector<float>(column.begin(), column.end()), std::vector<float>(row.begin(), row.end())});
  }
}

MatchedFilter::MatchedFilter(const PsfReach& reach)
    : kernel_(reach.kernel(), 1e-3), square_(squares_of(reach.kernel()), 1e-3) {}

void MatchedFilter::filter(const PaddedPlane& in, const SeparableKernel& kernel, PaddedPlane& out) {
  const int half = kernel.half();
  bool add = false;
  for (const SeparableKernel::Term& term : kernel.terms()) {
    for (int y = -half; y < in.ny() + half; ++y) filter_line(in.at(-half, y), 1, term.row, rows_.row(y), false);
    for (int y = 0; y < in.ny(); ++y) filter_line(rows_.at(0, y - half), rows_.stride(), term.column, out.row(y), add);
    add = true;
  }
}

void MatchedFilter::apply(const PaddedPlane& residual, const PaddedPlane& weight) {
  if (weighted_.nx() != residual.nx() || weighted_.ny() != residual.ny()) {
    weighted_ = PaddedPlane(residual.nx(), residual.ny(), residual.pad());
    rows_ = weighted_;
    significance_ = weighted_;
    information_ = weighted_;
  }
  for (int y = 0; y < residual.ny(); ++y) {
    const auto w = weight.row(y);
    const auto r = residual.row(y);
    const auto out = weighted_.row(y);
    for (std::size_t x = 0; x < out.size(); ++x) out[x] = w[x] * r[x];
  }
  filter(weighted_, kernel_, significance_);
  filter(weight, square_, information_);
  for (int y = 0; y < residual.ny(); ++y) {
    const auto s = significance_.row(y);
    const auto i = information_.row(y);
    // Rounding of a kernel's terms may leave less than nothing where all pixels are masked.
    for (std::size_t x = 0; x < s.size(); ++x) s[x] = i[x] > 0.0F ? s[x] / std::sqrt(i[x]) : 0.0F;
  }
}

std::vector<Peak> MatchedFilter::peaks(double threshold) const {
  std::vector<Peak> found;
  const int nx = significance_.nx();
  const int ny = significance_.ny();
  const auto least = static_cast<float>(threshold);
  for (int y = 0; y < ny; ++y) {
    const float* row = significance_.at(0, y);
    // The image has no neighbours outside: the margin must not hide a star at the edge, nor is it ever higher.
    const float* below = significance_.at(0, y > 0 ? y - 1 : y);
    const float* above = significance_.at(0, y + 1 < ny ? y + 1 : y);
    for (int x = 0; x < nx; ++x) {
      const float s = row[x];
      if (!(s > least)) continue;
      const int l = x > 0 ? x - 1 : x;
      const int r = x + 1 < nx ? x + 1 : x;
      // Of equal neighbours the first in the order of rows is the maximum.
      if (l != x && row[l] >= s) continue;
      if (r != x && row[r] > s) continue;
      if (y > 0 && (below[l] >= s || below[x] >= s || below[r] >= s)) continue;
      if (y + 1 < ny && (above[l] > s || above[x] > s || above[r] > s)) continue;
      const double information = static_cast<double>(*information_.at(x, y));
      found.push_back({x + top_of(row[l], s, row[r]), y + top_of(below[x], s, above[x]),
                       static_cast<double>(s) / std::sqrt(information), static_cast<double>(s)});
    }
  }
  return found;
}

}  // namespace astroid::detail
