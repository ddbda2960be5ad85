#include "astroid/test/field_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace astroid::test {

namespace {

constexpr double kEdge = 8.0;
constexpr int kReach = 6;       // px, of the window and of neighbours
constexpr double kZero = 25.0;  // magnitude of one electron

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

double robust_width(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> away;
  for (const double v : values) away.push_back(std::abs(v - middle));
  return 1.4826 * median(std::move(away));
}

// Shares of a Gaussian in pixels, and their derivatives with respect to its place, by erf of the standard library.
struct Profile {
  double scale;
  [[nodiscard]] double share(double u, int i) const {
    return 0.5 * (std::erf((i + 0.5 - u) * scale) - std::erf((i - 0.5 - u) * scale));
  }
  [[nodiscard]] double slope(double u, int i) const {
    const double root_pi = std::sqrt(std::acos(-1.0));
    const double below = (i - 0.5 - u) * scale;
    const double above = (i + 0.5 - u) * scale;
    return scale / root_pi * (std::exp(-below * below) - std::exp(-above * above));
  }
};

// Lower bound of the standard deviation of the first flux, by elimination of all the rest; infinity without one.
double bound_of(const std::vector<std::vector<double>>& rows, const std::vector<double>& variance) {
  const std::size_t n = rows.size();
  std::vector<double> fisher(n * n);
  // The first parameter last: its pivot is then what is left when all the others are free.
  const auto row = [&](std::size_t i) -> const std::vector<double>& { return rows[n - 1 - i]; };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < variance.size(); ++k) sum += row(i)[k] * row(j)[k] / variance[k];
      fisher[i * n + j] = sum;
    }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) fisher[j * n + j] -= fisher[j * n + k] * fisher[j * n + k];
    if (!(fisher[j * n + j] > 0.0)) return std::numeric_limits<double>::infinity();
    const double pivot = std::sqrt(fisher[j * n + j]);
    fisher[j * n + j] = pivot;
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) fisher[i * n + j] -= fisher[i * n + k] * fisher[j * n + k];
      fisher[i * n + j] /= pivot;
    }
  }
  return 1.0 / fisher[n * n - 1];
}

class Bounds {
 public:
  Bounds(const StarField& field, const StarFieldSettings& s)
      : field_(field),
        nx_(s.nx),
        ny_(s.ny),
        floor_(s.sky + s.read_noise * s.read_noise),
        profile_{2.3548200450309493 / (std::sqrt(2.0) * s.fwhm)},
        variance_(static_cast<std::size_t>(s.nx) * static_cast<std::size_t>(s.ny), floor_) {
    const int reach = std::max(kReach, static_cast<int>(std::ceil(8.0 / (std::sqrt(2.0) * profile_.scale))));
    for (const TrueStar& star : field.stars)
      visit(star, reach, [&](int x, int y, std::size_t) {
        variance_[index(x, y)] += star.flux * profile_.share(star.x, x) * profile_.share(star.y, y);
      });
    for (const TrueStar& star : field.stars) {
      std::vector<std::vector<double>> rows = rows_of(star, star);
      std::vector<double> variance;
      for (const double p : rows[0]) variance.push_back(floor_ + star.flux * p);
      alone_.push_back(bound_of(rows, variance));
    }
  }

  [[nodiscard]] double operator()(std::size_t i) const {
    constexpr double kSeen = 5.0;  // sigma
    const TrueStar& star = field_.stars[i];
    if (!(star.flux > kSeen * alone_[i])) return alone_[i];
    std::vector<std::vector<double>> rows = rows_of(star, star);
    for (std::size_t q = 0; q < field_.stars.size(); ++q) {
      const TrueStar& other = field_.stars[q];
      if (q == i || std::hypot(other.x - star.x, other.y - star.y) > kReach || !(other.flux > kSeen * alone_[q]))
        continue;
      for (auto& row : rows_of(other, star)) rows.push_back(std::move(row));
    }
    std::vector<double> variance;
    visit(star, kReach, [&](int x, int y, std::size_t) { variance.push_back(variance_[index(x, y)]); });
    const double bound = bound_of(rows, variance);
    return std::isfinite(bound) ? bound : alone_[i];
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x);
  }
  template <class Visit>
  void visit(const TrueStar& star, int reach, Visit function) const {
    const int x0 = static_cast<int>(std::lround(star.x));
    const int y0 = static_cast<int>(std::lround(star.y));
    std::size_t k = 0;
    for (int y = std::max(0, y0 - reach); y <= std::min(ny_ - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(nx_ - 1, x0 + reach); ++x) function(x, y, k++);
  }
  // Derivatives of a star's light with respect to flux, x and y, in the pixels around another.
  [[nodiscard]] std::vector<std::vector<double>> rows_of(const TrueStar& star, const TrueStar& window) const {
    std::vector<std::vector<double>> rows(3);
    visit(window, kReach, [&](int x, int y, std::size_t) {
      const double px = profile_.share(star.x, x);
      const double py = profile_.share(star.y, y);
      rows[0].push_back(px * py);
      rows[1].push_back(star.flux * profile_.slope(star.x, x) * py);
      rows[2].push_back(star.flux * px * profile_.slope(star.y, y));
    });
    return rows;
  }

  const StarField& field_;
  int nx_;
  int ny_;
  double floor_;
  Profile profile_;
  std::vector<double> variance_;
  std::vector<double> alone_;
};

}  // namespace

void FieldScore::add(const StarField& field, const StarFieldSettings& settings,
                     std::span<const MeasuredStar> measured) {
  const auto inside = [&](double x, double y) {
    return x > kEdge && x < settings.nx - 1 - kEdge && y > kEdge && y < settings.ny - 1 - kEdge;
  };
  std::vector<std::size_t> order(field.stars.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return field.stars[a].flux > field.stars[b].flux; });
  // Detections by rows, so that each star looks at few.
  std::vector<std::vector<std::size_t>> rows(static_cast<std::size_t>(settings.ny));
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (measured[i].flux > 0.0)
      rows[static_cast<std::size_t>(std::clamp(static_cast<int>(measured[i].y), 0, settings.ny - 1))].push_back(i);
  const Bounds bounds(field, settings);
  std::vector<char> used(measured.size(), 0);
  std::vector<char> fine(measured.size(), 0);
  for (const std::size_t i : order) {
    const TrueStar& star = field.stars[i];
    std::size_t best = measured.size();
    double nearest = 1.0;
    const int row = static_cast<int>(star.y);
    for (int y = std::max(0, row - 2); y <= std::min(settings.ny - 1, row + 2); ++y)
      for (const std::size_t q : rows[static_cast<std::size_t>(y)]) {
        const double d = std::hypot(measured[q].x - star.x, measured[q].y - star.y);
        if (used[q] == 0 && d < nearest) {
          nearest = d;
          best = q;
        }
      }
    bool good = false;
    if (best < measured.size()) {
      used[best] = 1;
      constexpr double kClose = 0.75;  // mag
      good = std::abs(2.5 * std::log10(measured[best].flux / star.flux)) < kClose;
    }
    if (good) fine[best] = 1;
    if (!inside(star.x, star.y)) continue;
    const double error = good ? measured[best].flux - star.flux : 0.0;
    if (good) pulls_.push_back({kZero - 2.5 * std::log10(star.flux), star.flux, error, measured[best].flux_err});
    constexpr double kBright = 10.0;
    const double bound = bounds(i);
    if (!(star.flux > kBright * bound)) continue;
    ++expected_;
    if (!good) continue;
    ++hits_;
    relative_.push_back(error / star.flux);
    in_bounds_.push_back(error / bound);
  }
  for (std::size_t q = 0; q < measured.size(); ++q) {
    if (!(measured[q].flux > 0.0) || !inside(measured[q].x, measured[q].y)) continue;
    ++detections_;
    bad_ += fine[q] == 0 ? 1 : 0;
  }
}

double FieldScore::found() const {
  return static_cast<double>(hits_) / static_cast<double>(expected_);
}

double FieldScore::bad() const {
  return static_cast<double>(bad_) / static_cast<double>(detections_);
}

double FieldScore::bias() const {
  return median(relative_);
}

double FieldScore::scatter() const {
  return robust_width(in_bounds_);
}

double FieldScore::median_bias_error() const {
  constexpr double kMedian = 1.2533;
  return kMedian * robust_width(relative_) / std::sqrt(static_cast<double>(relative_.size()));
}

double FieldScore::pull_width(double mag, std::size_t& count) const {
  std::vector<double> relative;
  for (const Pull& p : pulls_)
    if (std::abs(p.magnitude - mag) < 0.5) relative.push_back(p.error / p.flux);
  const double offset = median(relative);
  std::vector<double> pulls;
  for (const Pull& p : pulls_)
    if (std::abs(p.magnitude - mag) < 0.5) pulls.push_back((p.error - offset * p.flux) / p.flux_err);
  count = pulls.size();
  return robust_width(pulls);
}

// The median absolute deviation has 0.37 of the information of the standard deviation.
double FieldScore::width_error(std::size_t n) {
  return 1.17 / std::sqrt(static_cast<double>(n));
}

}  // namespace astroid::test
