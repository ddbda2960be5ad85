// The Poisson distribution the plain way: weights relative to the most probable count, outwards until they vanish.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace astroid::test {

/// Every probability in 80-bit arithmetic, by the recurrence p(n + 1) = p(n) mean / (n + 1) and division by the sum.
class PoissonOracle {
 public:
  explicit PoissonOracle(double mean) {
    const long double lambda = mean;
    const long double mode = std::floor(lambda);
    constexpr long double kVanishing = 1e-60L;
    std::vector<long double> below;
    for (long double n = mode, weight = 1.0L; n > 0.0L && weight > kVanishing; --n)
      below.push_back(weight *= n / lambda);
    first_ = static_cast<double>(mode) - static_cast<double>(below.size());
    probabilities_.assign(below.rbegin(), below.rend());
    probabilities_.push_back(1.0L);
    for (long double n = mode + 1.0L, weight = 1.0L; weight > kVanishing; ++n)
      probabilities_.push_back(weight *= lambda / n);
    // Sums from the small end of each tail, so both tails keep their relative accuracy.
    lower_.resize(probabilities_.size());
    upper_.resize(probabilities_.size());
    long double sum = 0.0L;
    for (std::size_t i = 0; i < probabilities_.size(); ++i) lower_[i] = sum += probabilities_[i];
    const long double total = sum;
    sum = 0.0L;
    for (std::size_t i = probabilities_.size(); i-- > 0;) {
      upper_[i] = sum / total;
      sum += probabilities_[i];
      lower_[i] /= total;
    }
  }

  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return first_ + static_cast<double>(lower_.size()) - 1.0; }
  /// P(X <= n) and P(X > n), first() <= n <= last().
  [[nodiscard]] long double lower(double n) const { return lower_[static_cast<std::size_t>(n - first_)]; }
  [[nodiscard]] long double upper(double n) const { return upper_[static_cast<std::size_t>(n - first_)]; }

  /// Smallest n with u < P(X <= n) + slack * (the shorter tail there), u = (word + 1/2) / 2^64.
  [[nodiscard]] double quantile(std::uint64_t word, long double slack) const {
    const bool low = word < 0x8000000000000000U;
    const long double u = (static_cast<long double>(low ? word : ~word) + 0.5L) * 0x1p-64L;
    std::size_t begin = 0;
    std::size_t end = lower_.size() - 1;
    while (begin < end) {
      const std::size_t middle = (begin + end) / 2;
      const bool covered = low ? u < lower_[middle] * (1.0L + slack) : u > upper_[middle] * (1.0L - slack);
      if (covered) {
        end = middle;
      } else {
        begin = middle + 1;
      }
    }
    return first_ + static_cast<double>(begin);
  }

 private:
  double first_ = 0.0;
  std::vector<long double> probabilities_;
  std::vector<long double> lower_;
  std::vector<long double> upper_;
};

}  // namespace astroid::test
