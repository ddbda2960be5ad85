#include "astroid/core/statistics/sums.hpp"

#include <cmath>
#include <cstddef>

namespace astroid {

namespace {

constexpr std::size_t kLeaf = 64;  // values added one by one at the bottom

template <class T>
double sum_by_halves(std::span<const T> values) {
  if (values.size() <= kLeaf) {
    double sum = 0.0;
    for (const T value : values) sum += static_cast<double>(value);
    return sum;
  }
  const std::size_t half = values.size() / 2;
  return sum_by_halves(values.first(half)) + sum_by_halves(values.subspan(half));
}

}  // namespace

double pairwise_sum(std::span<const double> values) {
  return sum_by_halves(values);
}
double pairwise_sum(std::span<const float> values) {
  return sum_by_halves(values);
}

void RunningMoments::merge(const RunningMoments& other) {
  if (other.count_ == 0) return;
  const auto mine = static_cast<double>(count_);
  const auto theirs = static_cast<double>(other.count_);
  const double delta = other.mean_ - mean_;
  count_ += other.count_;
  mean_ += delta * (theirs / (mine + theirs));
  squares_ += other.squares_ + delta * delta * (mine * theirs / (mine + theirs));
}

double RunningMoments::standard_deviation() const {
  return std::sqrt(variance());
}

double variance_relative_error(std::int64_t n, double poisson_mean) {
  const auto count = static_cast<double>(n);
  return std::sqrt(2.0 / (count - 1.0) + 1.0 / (poisson_mean * count));
}

}  // namespace astroid
