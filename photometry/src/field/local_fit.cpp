#include "field/local_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/place.hpp"
#include "field/stamp_sums.hpp"
#include "small_matrix.hpp"

namespace astroid::detail {

namespace {

// A diagonal element that loses all but this share of itself has nothing left but rounding of single precision.
constexpr double kLeastShare = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void LocalFit::gather(double x, double y, std::size_t without) {
  field_.neighbours().find(x, y, field_.coupling_reach(), near_);
  std::erase(near_, static_cast<std::uint32_t>(without));
  const auto square = [&](std::uint32_t i) {
    const double dx = field_.stars()[i].x - x;
    const double dy = field_.stars()[i].y - y;
    return dx * dx + dy * dy;
  };
  if (near_.size() > kMostNeighbours) {
    std::sort(near_.begin(), near_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double da = square(a);
      const double db = square(b);
      return da != db ? da < db : a < b;
    });
    near_.resize(kMostNeighbours);
  }
  nearest_ = kInfinity;
  for (const std::uint32_t i : near_) nearest_ = std::min(nearest_, std::sqrt(square(i)));
  std::sort(near_.begin(), near_.end());
}

void LocalFit::fill_neighbours(std::size_t n) {
  matrix_.assign(n * n, 0.0);
  for (std::size_t a = 0; a < near_.size(); ++a) {
    const auto& c = field_.terms()[near_[a]].curvature;
    double* m = matrix_.data() + 3 * a * n + 3 * a;
    m[0] = c[0];
    m[n] = c[1];
    m[n + 1] = c[3];
    m[2 * n] = c[2];
    m[2 * n + 1] = c[4];
    m[2 * n + 2] = c[5];
    // Rows of the later star, columns of the earlier one: the lower triangle.
    for (std::size_t b = a + 1; b < near_.size(); ++b) {
      const PairTerms* pair = field_.pair(near_[a], near_[b]);
      if (pair == nullptr) continue;
      double* block = matrix_.data() + 3 * b * n + 3 * a;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) block[i * n + j] = pair->curvature[3 * j + i];
    }
  }
}

StarCovariance LocalFit::covariance(std::size_t star) {
  const ModelStar& s = field_.stars()[star];
  gather(s.x, s.y, star);
  const std::size_t others = 3 * near_.size();
  const std::size_t n = others + 3;
  fill_neighbours(n);
  // The star comes last, its flux at the very end: x, y, F.
  constexpr std::array<std::size_t, 3> kOrder{1, 2, 0};
  constexpr std::array<std::array<std::size_t, 3>, 3> kElement{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  const auto& c = field_.terms()[star].curvature;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j) matrix_[(others + i) * n + others + j] = c[kElement[kOrder[i]][kOrder[j]]];
  for (std::size_t a = 0; a < near_.size(); ++a) {
    const bool first = near_[a] < star;
    const PairTerms* pair = first ? field_.pair(near_[a], star) : field_.pair(star, near_[a]);
    if (pair == nullptr) continue;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        matrix_[(others + i) * n + 3 * a + j] =
            first ? pair->curvature[3 * j + kOrder[i]] : pair->curvature[3 * kOrder[i] + j];
  }
  const double alone = c[0];
  cholesky(matrix_, n, kLeastShare);
  StarCovariance result;
  // The inverse's last three rows and columns need only the factor's last block: (L L^T)^-1 = L^-T L^-1.
  std::array<std::array<double, 3>, 3> inverse{};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = j; i < 3; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (std::size_t k = j; k < i; ++k) sum -= matrix_[(others + i) * n + others + k] * inverse[k][j];
      inverse[i][j] = sum / matrix_[(others + i) * n + others + i];
    }
  }
  std::array<std::array<double, 3>, 3> covariance{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = std::max(i, j); k < 3; ++k) covariance[i][j] += inverse[k][i] * inverse[k][j];
  result.degenerate = !(alone > 0.0) || matrix_[n * n - 1] == kTakenOut;
  if (result.degenerate) {
    result.covariance.fill(kInfinity);
    result.share = 0.0;
    return result;
  }
  result.covariance = {covariance[2][2], covariance[2][0], covariance[2][1],
                       covariance[0][0], covariance[0][1], covariance[1][1]};
  result.share = std::min(1.0, 1.0 / (alone * covariance[2][2]));
  return result;
}

FluxEstimate LocalFit::candidate(double x, double y) {
  constexpr auto kNone = static_cast<std::size_t>(std::numeric_limits<std::uint32_t>::max());
  gather(x, y, kNone);
  const std::size_t others = 3 * near_.size();
  const std::size_t n = others + 1;
  fill_neighbours(n);
  const int half = field_.reach().core();
  const int side = 2 * half + 1;
  const int stride = StarStamps::stride_of(half);
  const auto plane = place_in(0, side, stride);
  const Rectangle box{static_cast<int>(std::floor(x + 0.5)) - half, static_cast<int>(std::floor(y + 0.5)) - half, side,
                      side};
  fractions_.resize(box.size());
  field_.psf().integrate({x, y}, box, fractions_);
  // Position derivatives stay zero: a candidate has a flux only.
  stamp_.assign(2 * plane + 4, 0.0F);
  weighted_.assign(3 * plane + 4, 0.0F);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      stamp_[place_in(i, j, stride)] = static_cast<float>(fractions_[place_in(i, j, side)]);
  const StampView stamp{stamp_.data(), stamp_.data() + plane, stamp_.data() + plane, box.x0, box.y0, side, stride};
  const WeightedStamp weighted{weighted_.data(), weighted_.data() + plane, weighted_.data() + 2 * plane};
  const StampSums sums = weigh_stamp(stamp, field_.weight(), field_.residual(), weighted);
  right_.assign(n, 0.0);
  for (std::size_t a = 0; a < near_.size(); ++a) {
    const std::array<double, 9> shared = pair_sums(stamp, weighted, field_.stamps()[near_[a]]);
    const double f = field_.stars()[near_[a]].flux;
    double* row = matrix_.data() + others * n + 3 * a;
    row[0] = shared[0];
    row[1] = f * shared[1];
    row[2] = f * shared[2];
    for (std::size_t k = 0; k < 3; ++k) right_[3 * a + k] = field_.terms()[near_[a]].slope[k];
  }
  matrix_[n * n - 1] = sums.pp;
  right_[others] = sums.rp;
  cholesky(matrix_, n, kLeastShare);
  solve_lower(matrix_, n, right_);
  const double diagonal = matrix_[n * n - 1];
  if (!(diagonal > 0.0) || diagonal == kTakenOut) return {0.0, kInfinity};
  return {right_[others] / diagonal, 1.0 / diagonal};
}

}  // namespace astroid::detail
