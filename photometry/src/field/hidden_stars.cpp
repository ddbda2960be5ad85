#include "field/hidden_stars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "astroid/core/math.hpp"
#include "small_matrix.hpp"

namespace astroid::detail {

namespace {

constexpr double kBinsPerDecade = 8.0;
constexpr double kClassesPerDecade = 4.0;

// Shifts of a small share e of normal values by much widen the interval that holds 68.27 % of them by e P / (2 phi(1))
// of itself: as much as a variance e c² with c² = P / phi(1).
constexpr double kOneSigmaShare = 0.6826894921370859;
constexpr double kOneSigmaDensity = 0.24197072451914337;  // phi(1)
constexpr double kLargestSquare = kOneSigmaShare / kOneSigmaDensity;

}  // namespace

HiddenStars::HiddenStars(FieldSolver& field, const MatchedFilter& filter, double threshold) {
  measure_residuals(field, filter, threshold);
  count_stars(field, threshold);
  double brightest = faintest_;
  for (const ModelStar& star : field.stars()) brightest = std::max(brightest, star.flux);
  const double decades = det::log10(brightest / faintest_);
  const int classes = 1 + static_cast<int>(std::ceil(decades * kClassesPerDecade));
  for (int k = 0; k <= classes; ++k)
    classes_.push_back(make_class(field, faintest_ * det::exp10(k / kClassesPerDecade), threshold));
}

void HiddenStars::measure_residuals(const FieldSolver& field, const MatchedFilter& filter, double threshold) {
  const PaddedPlane& significance = filter.significance();
  PaddedPlane taken(significance.nx(), significance.ny(), 0);
  const double radius = 1.2 * field.reach().fwhm();
  for (const ModelStar& star : field.stars()) {
    const int y0 = std::max(0, static_cast<int>(std::ceil(star.y - radius)));
    const int y1 = std::min(taken.ny() - 1, static_cast<int>(std::floor(star.y + radius)));
    for (int y = y0; y <= y1; ++y) {
      const double half = std::sqrt(std::max(0.0, radius * radius - (y - star.y) * (y - star.y)));
      const int x0 = std::max(0, static_cast<int>(std::ceil(star.x - half)));
      const int x1 = std::min(taken.nx() - 1, static_cast<int>(std::floor(star.x + half)));
      for (int x = x0; x <= x1; ++x) *taken.at(x, y) = 1.0F;
    }
  }
  double squares = 0.0;
  double variance = 0.0;
  std::size_t count = 0;
  const auto limit = static_cast<float>(threshold);
  for (int y = 0; y < taken.ny(); ++y) {
    const auto s = significance.row(y);
    const auto t = taken.row(y);
    const auto w = field.weight().row(y);
    for (std::size_t x = 0; x < s.size(); ++x) {
      if (t[x] > 0.0F || !(w[x] > 0.0F) || std::abs(s[x]) > limit) continue;
      squares += static_cast<double>(s[x]) * static_cast<double>(s[x]);
      variance += 1.0 / static_cast<double>(w[x]);
      ++count;
    }
  }
  if (count == 0) return;
  residual_variance_ = squares / static_cast<double>(count);
  pixel_variance_ = variance / static_cast<double>(count);
}

void HiddenStars::count_stars(const FieldSolver& field, double threshold) {
  faintest_ = threshold * std::sqrt(pixel_variance_ * field.reach().noise_pixels());
  area_ = static_cast<double>(field.light().nx()) * field.light().ny();
  for (const ModelStar& star : field.stars()) {
    if (!(star.flux > faintest_)) continue;
    const auto bin = static_cast<std::size_t>(det::log10(star.flux / faintest_) * kBinsPerDecade);
    if (bin >= bin_density_.size()) bin_density_.resize(bin + 1, 0.0);
    bin_density_[bin] += 1.0 / area_;
  }
  for (std::size_t b = 0; b < bin_density_.size(); ++b)
    bin_flux_.push_back(faintest_ * det::exp10((static_cast<double>(b) + 0.5) / kBinsPerDecade));
}

HiddenStars::Class HiddenStars::make_class(const FieldSolver& field, double flux, double threshold) const {
  const PixelPsf& psf = field.psf();
  const PsfReach& reach = field.reach();
  const int nx = field.light().nx();
  const int ny = field.light().ny();
  const PixelPosition star{std::floor(0.5 * nx), std::floor(0.5 * ny)};
  const int half = std::min(reach.most(), 2 * reach.core() + 1);
  const int side = 2 * half + 1;
  const Rectangle box{static_cast<int>(star.x) - half, static_cast<int>(star.y) - half, side, side};
  const std::size_t n = box.size();
  std::vector<double> p(n);
  std::vector<double> px(n);
  std::vector<double> py(n);
  std::vector<double> weight(n);
  std::vector<double> other(n);
  std::vector<double> other_x(n);
  std::vector<double> other_y(n);
  psf.integrate(star, box, p);
  psf.integrate_gradient(star, box, px, py);
  std::array<double, 6> curvature{};
  for (std::size_t i = 0; i < n; ++i) {
    weight[i] = 1.0 / (pixel_variance_ + flux * std::max(0.0, p[i]));
    px[i] *= flux;
    py[i] *= flux;
    curvature[0] += weight[i] * p[i] * p[i];
    curvature[1] += weight[i] * p[i] * px[i];
    curvature[2] += weight[i] * p[i] * py[i];
    curvature[3] += weight[i] * px[i] * px[i];
    curvature[4] += weight[i] * px[i] * py[i];
    curvature[5] += weight[i] * py[i] * py[i];
  }
  const std::array<double, 9> covariance = inverse_of_symmetric(curvature);
  const double variance = covariance[0];

  const double step = 0.2 * std::max(1.0, reach.fwhm());
  constexpr int kSteps = 12;
  double near_variance = 0.0;
  double response = 0.0;
  double faint_response = 0.0;
  for (int ring_index = 0; ring_index < kSteps; ++ring_index) {
    const double r = (ring_index + 0.5) * step;
    const double ring = 2.0 * kPi * r * step;
    constexpr double kDiagonal = 0.7071067811865476;
    for (const PixelPosition direction : {PixelPosition{1.0, 0.0}, PixelPosition{kDiagonal, kDiagonal}}) {
      const PixelPosition place{star.x + r * direction.x, star.y + r * direction.y};
      psf.integrate(place, box, other);
      psf.integrate_gradient(place, box, other_x, other_y);
      const std::array<const double*, 3> first{p.data(), px.data(), py.data()};
      const std::array<const double*, 3> second{other.data(), other_x.data(), other_y.data()};
      std::array<double, 9> shared{};  // of the star's parameters, and the companion's
      std::array<double, 6> own{};     // of the companion's alone: its flux and place, per unit flux
      double plain = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3; ++b) shared[3 * a + b] += weight[i] * first[a][i] * second[b][i];
        std::size_t element = 0;
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = a; b < 3; ++b) own[element++] += weight[i] * second[a][i] * second[b][i];
        plain += p[i] * other[i];
      }
      std::array<double, 9> response_of{};  // of the star's parameters to the companion's
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          for (std::size_t k = 0; k < 3; ++k) response_of[3 * a + b] += covariance[3 * a + k] * shared[3 * k + b];
      const double gain = response_of[0];
      std::size_t element = 0;
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = a; b < 3; ++b, ++element)
          for (std::size_t k = 0; k < 3; ++k) own[element] -= shared[3 * k + a] * response_of[3 * k + b];
      const double companion_variance = inverse_of_symmetric(own)[0];
      const double detected = companion_variance > 0.0 ? threshold * std::sqrt(companion_variance)
                                                       : std::numeric_limits<double>::infinity();
      response += 0.5 * ring * gain * gain;
      faint_response += 0.5 * ring * (plain * reach.noise_pixels()) * (plain * reach.noise_pixels());
      // A companion brighter than the star would itself be the star that is seen.
      const double most = std::min(detected, flux);
      for (std::size_t bin = 0; bin < bin_flux_.size() && bin_flux_[bin] < most; ++bin) {
        const double shift = bin_flux_[bin] * gain;
        near_variance += 0.5 * ring * bin_density_[bin] * std::min(shift * shift, kLargestSquare * variance);
      }
    }
  }
  const double empty_variance = pixel_variance_ * reach.noise_pixels();
  const double far_variance =
      std::max(0.0, residual_variance_ - 1.0) * empty_variance * response / std::max(faint_response, 1e-300);
  return {det::log10(flux), (near_variance + far_variance) / variance};
}

double HiddenStars::excess(double flux) const {
  if (classes_.empty()) return 0.0;
  const double t = (det::log10(std::max(flux, 1e-300)) - classes_.front().log_flux) * kClassesPerDecade;
  const double last = static_cast<double>(classes_.size() - 1);
  const auto i = static_cast<std::size_t>(std::clamp(t, 0.0, std::max(0.0, last - 1.0)));
  if (i + 1 >= classes_.size()) return classes_[i].excess;
  const double share = std::clamp(t - static_cast<double>(i), 0.0, 1.0);
  return classes_[i].excess + share * (classes_[i + 1].excess - classes_[i].excess);
}

}  // namespace astroid::detail
