#include "psf/psf_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace astroid::detail {

namespace {

// What the prior may be wrong by: this share of itself, and this share of its largest coefficient.
constexpr double kPriorShare = 0.5;
constexpr double kPriorFloor = 0.02;
// The same of second differences along the grid, relative to the above.
constexpr double kRoughness = 0.3;
// Variation over the field, relative to the above.
constexpr double kVariation = 0.3;
// Residuals beyond this many sigma lose weight.
constexpr double kRobust = 3.0;
constexpr double kTolerance = 1e-3;

}  // namespace

PsfFit::PsfFit(const FieldSolver& field, std::span<const std::size_t> stars, const EffectivePsf& present,
               const EffectivePsf& prior, const PsfFitSettings& settings)
    : present_(present),
      prior_(prior),
      half_(present.half / present.samples_per_pixel),
      side_(static_cast<std::size_t>(2 * half_ + 1)),
      most_iterations_(settings.most_iterations) {
  const std::size_t n = stars.size() * side_ * side_;
  root_weight_.resize(n);
  residual_.resize(n);
  basis_.resize(kFree * n);
  const double largest = *std::ranges::max_element(prior_.coefficients);
  for (const double c : prior_.coefficients) {
    const double deviation = kPriorShare * std::abs(c) + kPriorFloor * largest;
    precision_.push_back(1.0 / (deviation * deviation));
  }
  for (const std::size_t index : stars) add_star(field, index, settings);
}

void PsfFit::add_star(const FieldSolver& field, std::size_t index, const PsfFitSettings& settings) {
  const ModelStar& model = field.stars()[index];
  const EffectiveAxis ax = effective_axis(present_, model.x);
  const EffectiveAxis ay = effective_axis(present_, model.y);
  Star star;
  EffectivePsf all;  // terms, whatever is present
  all.order = 2;
  all.field_centre = present_.field_centre;
  all.field_scale = present_.field_scale;
  field_terms(all, {model.x, model.y}, star.phi.data());
  star.flux = model.flux;
  star.start_x = ax.first - half_ * present_.samples_per_pixel;
  star.start_y = ay.first - half_ * present_.samples_per_pixel;
  std::copy_n(ax.weights.weight, 4, star.wx.begin());
  std::copy_n(ay.weights.weight, 4, star.wy.begin());
  star.offset = stars_.size() * side_ * side_;
  const int x0 = ax.pixel - half_;
  const int y0 = ay.pixel - half_;
  const std::size_t n = side_ * side_;
  std::vector<double> p(n);
  std::vector<double> px(n);
  std::vector<double> py(n);
  const Rectangle box{x0, y0, static_cast<int>(side_), static_cast<int>(side_)};
  field.psf().integrate({model.x, model.y}, box, p);
  field.psf().integrate_gradient({model.x, model.y}, box, px, py);
  for (std::size_t j = 0; j < side_; ++j) {
    const int y = y0 + static_cast<int>(j);
    for (std::size_t i = 0; i < side_; ++i) {
      const int x = x0 + static_cast<int>(i);
      const std::size_t k = j * side_ + i;
      const auto weight = static_cast<double>(*field.weight().at(x, y));
      const auto residual = static_cast<double>(*field.residual().at(x, y));
      double root = 0.0;
      if (weight > 0.0) {
        const double own = star.flux * p[k];
        const double others = static_cast<double>(*field.light().at(x, y)) - own;
        const double doubt = settings.model_error * own;
        const double neighbours = settings.neighbour_error * others;
        const double variance = 1.0 / weight + doubt * doubt + neighbours * neighbours;
        const double sigmas = residual * residual / (variance * kRobust * kRobust);
        root = 1.0 / std::sqrt(variance * (1.0 + sigmas));
        ++usable_pixels_;
      }
      root_weight_[star.offset + k] = root;
      residual_[star.offset + k] = root * residual;
      double* b = basis_.data() + kFree * star.offset + k;
      b[0] = root * p[k];
      b[n] = root * px[k];
      b[2 * n] = root * py[k];
    }
  }
  // Gram-Schmidt, twice: position and flux of a star are far from parallel unless most of it is masked.
  for (std::size_t a = 0; a < kFree; ++a) {
    double* v = basis_.data() + kFree * star.offset + a * n;
    const double before = std::sqrt(std::inner_product(v, v + n, v, 0.0));
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t b = 0; b < a; ++b) {
        const double* u = basis_.data() + kFree * star.offset + b * n;
        const double dot = std::inner_product(v, v + n, u, 0.0);
        for (std::size_t k = 0; k < n; ++k) v[k] -= dot * u[k];
      }
    const double norm = std::sqrt(std::inner_product(v, v + n, v, 0.0));
    constexpr double kParallel = 1e-6;
    const double scale = norm > kParallel * before && norm > 0.0 ? 1.0 / norm : 0.0;
    for (std::size_t k = 0; k < n; ++k) v[k] *= scale;
  }
  stars_.push_back(star);
  project(star, std::span(residual_).subspan(star.offset, n));
}

void PsfFit::project(const Star& star, std::span<double> pixels) const {
  const std::size_t n = pixels.size();
  for (std::size_t a = 0; a < kFree; ++a) {
    const double* u = basis_.data() + kFree * star.offset + a * n;
    const double dot = std::inner_product(pixels.begin(), pixels.end(), u, 0.0);
    for (std::size_t k = 0; k < n; ++k) pixels[k] -= dot * u[k];
  }
}

void PsfFit::combine(const Star& star, std::span<const double> coefficients, std::size_t terms,
                     std::vector<double>& plane) const {
  const std::size_t n = present_.plane_size();
  plane.assign(coefficients.begin(), coefficients.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t k = 1; k < terms; ++k) {
    const double* c = coefficients.data() + k * n;
    for (std::size_t i = 0; i < n; ++i) plane[i] += star.phi[k] * c[i];
  }
}

void PsfFit::forward(const Star& star, std::span<const double> plane, std::span<double> pixels) const {
  const int grid = present_.side();
  const int step = present_.samples_per_pixel;
  const auto width = static_cast<std::size_t>(grid);
  std::vector<double> rows(width * side_);
  const auto inside = [grid](int i) { return i >= 0 && i < grid; };
  for (int r = 0; r < grid; ++r) {
    const double* c = plane.data() + static_cast<std::size_t>(r) * width;
    double* out = rows.data() + static_cast<std::size_t>(r) * side_;
    for (std::size_t i = 0; i < side_; ++i) {
      const int first = star.start_x + step * static_cast<int>(i);
      double sum = 0.0;
      if (first >= 0 && first + 3 < grid) {
        const double* s = c + first;
        sum = star.wx[0] * s[0] + star.wx[1] * s[1] + star.wx[2] * s[2] + star.wx[3] * s[3];
      } else {
        for (int a = 0; a < 4; ++a)
          if (inside(first + a)) sum += star.wx[static_cast<std::size_t>(a)] * c[first + a];
      }
      out[i] = sum;
    }
  }
  const double* root = root_weight_.data() + star.offset;
  for (std::size_t j = 0; j < side_; ++j) {
    double* out = pixels.data() + j * side_;
    std::fill_n(out, side_, 0.0);
    for (int b = 0; b < 4; ++b) {
      const int r = star.start_y + step * static_cast<int>(j) + b;
      if (!inside(r)) continue;
      const double w = star.flux * star.wy[static_cast<std::size_t>(b)];
      const double* in = rows.data() + static_cast<std::size_t>(r) * side_;
      for (std::size_t i = 0; i < side_; ++i) out[i] += w * in[i];
    }
    for (std::size_t i = 0; i < side_; ++i) out[i] *= root[j * side_ + i];
  }
}

void PsfFit::backward(const Star& star, std::span<const double> pixels, std::span<double> plane) const {
  const int grid = present_.side();
  const int step = present_.samples_per_pixel;
  const auto width = static_cast<std::size_t>(grid);
  std::vector<double> rows(width * side_, 0.0);
  const auto inside = [grid](int i) { return i >= 0 && i < grid; };
  const double* root = root_weight_.data() + star.offset;
  std::vector<double> weighted(side_);
  for (std::size_t j = 0; j < side_; ++j) {
    for (std::size_t i = 0; i < side_; ++i) weighted[i] = star.flux * root[j * side_ + i] * pixels[j * side_ + i];
    for (int b = 0; b < 4; ++b) {
      const int r = star.start_y + step * static_cast<int>(j) + b;
      if (!inside(r)) continue;
      const double w = star.wy[static_cast<std::size_t>(b)];
      double* out = rows.data() + static_cast<std::size_t>(r) * side_;
      for (std::size_t i = 0; i < side_; ++i) out[i] += w * weighted[i];
    }
  }
  for (int r = 0; r < grid; ++r) {
    double* c = plane.data() + static_cast<std::size_t>(r) * width;
    const double* in = rows.data() + static_cast<std::size_t>(r) * side_;
    for (std::size_t i = 0; i < side_; ++i) {
      const int first = star.start_x + step * static_cast<int>(i);
      for (int a = 0; a < 4; ++a)
        if (inside(first + a)) c[first + a] += star.wx[static_cast<std::size_t>(a)] * in[i];
    }
  }
}

void PsfFit::add_prior(std::span<const double> v, std::size_t terms, std::span<double> product) const {
  const std::size_t n = present_.plane_size();
  const auto width = static_cast<std::size_t>(present_.side());
  constexpr double kRough = 1.0 / (kRoughness * kRoughness);
  for (std::size_t k = 0; k < terms; ++k) {
    const double scale = k == 0 ? 1.0 : 1.0 / (kVariation * kVariation);
    const double* in = v.data() + k * n;
    double* out = product.data() + k * n;
    for (std::size_t i = 0; i < n; ++i) out[i] += scale * precision_[i] * in[i];
    const auto smooth = [&](std::size_t i, std::size_t step) {
      const double weight = scale * kRough * precision_[i];
      const double second = weight * (in[i - step] - 2.0 * in[i] + in[i + step]);
      out[i - step] += second;
      out[i] -= 2.0 * second;
      out[i + step] += second;
    };
    for (std::size_t j = 0; j < width; ++j)
      for (std::size_t i = 0; i < width; ++i) {
        if (i > 0 && i + 1 < width) smooth(j * width + i, 1);
        if (j > 0 && j + 1 < width) smooth(j * width + i, width);
      }
  }
}

void PsfFit::multiply(std::span<const double> v, std::size_t terms, std::span<const char> use,
                      std::span<double> product) const {
  std::ranges::fill(product, 0.0);
  const std::size_t n = present_.plane_size();
  std::vector<double> plane(n);
  std::vector<double> pixels(side_ * side_);
  for (std::size_t s = 0; s < stars_.size(); ++s) {
    if (!use.empty() && use[s] == 0) continue;
    const Star& star = stars_[s];
    if (terms == 1) {
      forward(star, v, pixels);
      project(star, pixels);
      backward(star, pixels, product);
      continue;
    }
    combine(star, v, terms, plane);
    forward(star, plane, pixels);
    project(star, pixels);
    std::ranges::fill(plane, 0.0);
    backward(star, pixels, plane);
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t i = 0; i < n; ++i) product[k * n + i] += star.phi[k] * plane[i];
  }
  add_prior(v, terms, product);
}

std::vector<double> PsfFit::diagonal(std::size_t terms, std::span<const char> use) const {
  const std::size_t n = present_.plane_size();
  std::vector<double> sum(terms * n, 0.0);
  std::vector<double> plane(n);
  std::vector<double> ones(side_ * side_);
  for (std::size_t s = 0; s < stars_.size(); ++s) {
    if (!use.empty() && use[s] == 0) continue;
    // F² w B²: the weights once more in the role of the pixels, and splines squared.
    Star star = stars_[s];
    for (double& w : star.wx) w *= w;
    for (double& w : star.wy) w *= w;
    for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = star.flux * root_weight_[star.offset + i];
    std::ranges::fill(plane, 0.0);
    backward(star, ones, plane);
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t i = 0; i < n; ++i) sum[k * n + i] += star.phi[k] * star.phi[k] * plane[i];
  }
  constexpr double kSecondDifferences = 12.0;  // 1 + 4 + 1 along both axes
  for (std::size_t k = 0; k < terms; ++k) {
    const double scale = (k == 0 ? 1.0 : 1.0 / (kVariation * kVariation)) *
                         (1.0 + kSecondDifferences / (kRoughness * kRoughness));
    for (std::size_t i = 0; i < n; ++i) sum[k * n + i] += scale * precision_[i];
  }
  return sum;
}

EffectivePsf PsfFit::solve(int order, std::span<const char> use) const {
  EffectivePsf result = present_;
  result.order = std::max(order, present_.order);
  const std::size_t terms = result.terms();
  const std::size_t n = present_.plane_size();
  result.coefficients.resize(terms * n, 0.0);
  std::vector<double> away(terms * n);
  for (std::size_t i = 0; i < away.size(); ++i)
    away[i] = (i < n ? prior_.coefficients[i] : 0.0) - result.coefficients[i];
  std::vector<double> residual(terms * n, 0.0);
  add_prior(away, terms, residual);
  std::vector<double> plane(n);
  for (std::size_t s = 0; s < stars_.size(); ++s) {
    if (!use.empty() && use[s] == 0) continue;
    const Star& star = stars_[s];
    std::ranges::fill(plane, 0.0);
    backward(star, std::span(residual_).subspan(star.offset, side_ * side_), plane);
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t i = 0; i < n; ++i) residual[k * n + i] += star.phi[k] * plane[i];
  }
  const std::vector<double> scale = diagonal(terms, use);
  std::vector<double> solution(terms * n, 0.0);
  std::vector<double> conditioned(terms * n);
  std::vector<double> product(terms * n);
  const auto precondition = [&] {
    for (std::size_t i = 0; i < conditioned.size(); ++i) conditioned[i] = residual[i] / scale[i];
  };
  precondition();
  std::vector<double> direction = conditioned;
  double rho = std::inner_product(residual.begin(), residual.end(), conditioned.begin(), 0.0);
  const double enough = kTolerance * kTolerance * rho;
  for (int iteration = 0; iteration < most_iterations_ && rho > enough && rho > 0.0; ++iteration) {
    multiply(direction, terms, use, product);
    const double curvature = std::inner_product(direction.begin(), direction.end(), product.begin(), 0.0);
    if (!(curvature > 0.0)) break;
    const double alpha = rho / curvature;
    for (std::size_t i = 0; i < solution.size(); ++i) {
      solution[i] += alpha * direction[i];
      residual[i] -= alpha * product[i];
    }
    precondition();
    const double next = std::inner_product(residual.begin(), residual.end(), conditioned.begin(), 0.0);
    const double beta = next / rho;
    rho = next;
    for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = conditioned[i] + beta * direction[i];
  }
  for (std::size_t i = 0; i < solution.size(); ++i) result.coefficients[i] += solution[i];
  return result;
}

std::vector<double> PsfFit::chi2(const EffectivePsf& psf) const {
  const std::size_t n = present_.plane_size();
  std::vector<double> change = psf.coefficients;
  for (std::size_t i = 0; i < present_.coefficients.size(); ++i) change[i] -= present_.coefficients[i];
  std::vector<double> result;
  std::vector<double> plane(n);
  std::vector<double> pixels(side_ * side_);
  for (const Star& star : stars_) {
    combine(star, change, psf.terms(), plane);
    forward(star, plane, pixels);
    project(star, pixels);
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double d = residual_[star.offset + i] - pixels[i];
      sum += d * d;
    }
    result.push_back(sum);
  }
  return result;
}

}  // namespace astroid::detail
