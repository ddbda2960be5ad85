#include "psf/psf_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "psf/psf_gauge.hpp"

namespace astroid::detail {

namespace {

// What the prior may be wrong by: this share of itself, and this share of its largest coefficient, which falls with
// the distance from the star as wings of diffraction do.
constexpr double kPriorShare = 0.5;
constexpr double kPriorFloor = 0.02;
constexpr double kWingSlope = 1.0;
// The same of second differences along the grid, relative to the above.
constexpr double kRoughness = 0.3;
// Variation over the field, relative to the above: of the terms of first and of second order.
constexpr std::array<double, 3> kVariation{1.0, 0.3, 0.1};

// Of 1, u, v, u², uv, v².
constexpr std::size_t order_of(std::size_t term) {
  return term == 0 ? 0 : term < 3 ? 1 : 2;
}
double variation_precision(std::size_t term) {
  const double v = kVariation[order_of(term)];
  return 1.0 / (v * v);
}
// Of flux (of 1) and of place (px), within which terms are held.
constexpr std::array<double, 3> kHeld{0.01, 0.01, 0.01};
// Residuals beyond this many sigma lose weight.
constexpr double kRobust = 3.0;

}  // namespace

PsfFit::PsfFit(const FieldSolver& field, std::span<const std::size_t> stars, const EffectivePsf& present,
               const EffectivePsf& prior, const PsfFitSettings& settings)
    : present_(present),
      prior_(prior),
      settings_(settings),
      pad_(3 * present.samples_per_pixel + 4),
      rows_(present.side() + 2 * pad_),
      run_(static_cast<std::size_t>((rows_ + present.samples_per_pixel - 1) / present.samples_per_pixel)) {
  const double largest = *std::ranges::max_element(prior_.coefficients);
  const double unit = std::max(1.0, field.reach().fwhm()) * present.samples_per_pixel;
  std::size_t i = 0;
  for (int y = -present.half; y <= present.half; ++y)
    for (int x = -present.half; x <= present.half; ++x) {
      const double square = (static_cast<double>(x) * x + static_cast<double>(y) * y) / (unit * unit);
      const double wing = std::pow(1.0 + square, -0.5 * kWingSlope);
      const double deviation = kPriorShare * std::abs(prior_.coefficients[i++]) + kPriorFloor * largest * wing;
      precision_.push_back(1.0 / (deviation * deviation));
    }
  gauge_ = gauge_weights(prior_, settings.window);
  std::vector<double> fluxes;
  for (const std::size_t index : stars) fluxes.push_back(field.stars()[index].flux);
  double least = 0.0;
  if (fluxes.size() > settings.whole_stars && settings.whole_stars > 0) {
    const auto nth = fluxes.begin() + static_cast<std::ptrdiff_t>(settings.whole_stars - 1);
    std::ranges::nth_element(fluxes, nth, std::greater<>());
    least = *nth;
  }
  const int whole = present.half / present.samples_per_pixel;
  const int core = std::min(whole, field.reach().core() + 1);
  for (const std::size_t index : stars)
    add_star(field, index, field.stars()[index].flux >= least ? whole : core, settings);
}

void PsfFit::add_star(const FieldSolver& field, std::size_t index, int half, const PsfFitSettings& settings) {
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
  star.side = 2 * half + 1;
  star.start_x = pad_ + ax.first - half * present_.samples_per_pixel;
  star.start_y = pad_ + ay.first - half * present_.samples_per_pixel;
  std::copy_n(ax.weights.weight, 4, star.wx.begin());
  std::copy_n(ay.weights.weight, 4, star.wy.begin());
  star.offset = root_weight_.size();
  const int x0 = ax.pixel - half;
  const int y0 = ay.pixel - half;
  const std::size_t n = star.pixels();
  const auto side = static_cast<std::size_t>(star.side);
  root_weight_.resize(star.offset + n);
  residual_.resize(star.offset + n);
  basis_.resize(kFree * (star.offset + n));
  std::vector<double> p(n);
  std::vector<double> px(n);
  std::vector<double> py(n);
  const Rectangle box{x0, y0, star.side, star.side};
  field.psf().integrate({model.x, model.y}, box, p);
  field.psf().integrate_gradient({model.x, model.y}, box, px, py);
  for (std::size_t j = 0; j < side; ++j) {
    const int y = y0 + static_cast<int>(j);
    for (std::size_t i = 0; i < side; ++i) {
      const int x = x0 + static_cast<int>(i);
      const std::size_t k = j * side + i;
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

void PsfFit::add_prior(std::span<const double> v, std::span<const double> prior, std::span<double> product) const {
  const std::size_t n = present_.plane_size();
  const auto width = static_cast<std::size_t>(present_.side());
  constexpr double kRough = 1.0 / (kRoughness * kRoughness);
  for (std::size_t k = 0; k < prior.size(); ++k) {
    const double scale = prior[k];
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

void PsfFit::add_gauge(std::span<const double> v, std::size_t terms, std::span<double> product) const {
  const std::size_t n = present_.plane_size();
  for (std::size_t k = 0; k < terms; ++k)
    for (std::size_t g = 0; g < gauge_.size(); ++g) {
      const std::vector<double>& weight = gauge_[g];
      const double sum = std::inner_product(weight.begin(), weight.end(), v.data() + k * n, 0.0);
      const double push = sum / (kHeld[g] * kHeld[g]);
      for (std::size_t i = 0; i < n; ++i) product[k * n + i] += push * weight[i];
    }
}

void PsfFit::multiply(std::span<const double> v, std::span<const double> prior, std::span<const char> use,
                      std::span<double> product) const {
  const std::size_t terms = prior.size();
  const std::vector<double> in = spread(v, terms);
  std::vector<double> out(in.size(), 0.0);
  std::vector<double> sum(in.size() / terms);
  std::vector<double> pixels;
  for (std::size_t s = 0; s < stars_.size(); ++s) {
    if (!use.empty() && use[s] == 0) continue;
    const Star& star = stars_[s];
    pixels.resize(star.pixels());
    if (terms > 1) combine(star, in, terms, sum);
    forward(star, terms > 1 ? std::span<const double>(sum) : std::span<const double>(in), pixels);
    project(star, pixels);
    if (terms > 1) for_each_run(star, [&](std::size_t i, std::size_t n) { std::fill_n(sum.data() + i, n, 0.0); });
    backward(star, pixels, terms > 1 ? std::span<double>(sum) : std::span<double>(out));
    if (terms > 1) add_terms(star, sum, terms, out);
  }
  gather(out, terms, product);
  add_prior(v, prior, product);
  add_gauge(v, terms, product);
}

std::vector<double> PsfFit::diagonal(std::span<const double> prior, std::span<const char> use) const {
  const std::size_t terms = prior.size();
  const std::size_t n = present_.plane_size();
  const std::size_t size = place(0, rows_);
  std::vector<double> phases(terms * size, 0.0);
  std::vector<double> plane(size);
  std::vector<double> ones;
  for (std::size_t s = 0; s < stars_.size(); ++s) {
    if (!use.empty() && use[s] == 0) continue;
    // F² w B²: the weights once more in the role of the pixels, and splines squared.
    Star star = stars_[s];
    for (double& w : star.wx) w *= w;
    for (double& w : star.wy) w *= w;
    for (double& p : star.phi) p *= p;
    ones.resize(star.pixels());
    for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = star.flux * root_weight_[star.offset + i];
    backward(star, ones, plane);
    add_terms(star, plane, terms, phases);
  }
  std::vector<double> sum(terms * n);
  gather(phases, terms, sum);
  constexpr double kSecondDifferences = 12.0;  // 1 + 4 + 1 along both axes
  for (std::size_t k = 0; k < terms; ++k) {
    const double scale = prior[k] * (1.0 + kSecondDifferences / (kRoughness * kRoughness));
    for (std::size_t i = 0; i < n; ++i) sum[k * n + i] += scale * precision_[i];
    for (std::size_t g = 0; g < gauge_.size(); ++g)
      for (std::size_t i = 0; i < n; ++i) {
        const double weight = gauge_[g][i] / kHeld[g];
        sum[k * n + i] += weight * weight;
      }
  }
  return sum;
}

EffectivePsf PsfFit::solve(const PsfFreedom& freedom, std::span<const char> use) const {
  EffectivePsf result = present_;
  result.order = std::max(freedom.order, present_.order);
  const std::size_t terms = result.terms();
  std::vector<double> prior{1.0 / (freedom.from_prior * freedom.from_prior)};
  for (std::size_t k = 1; k < terms; ++k) prior.push_back(variation_precision(k));
  const std::size_t n = present_.plane_size();
  result.coefficients.resize(terms * n, 0.0);
  std::vector<double> away(terms * n);
  for (std::size_t i = 0; i < away.size(); ++i)
    away[i] = (i < n ? prior_.coefficients[i] : 0.0) - result.coefficients[i];
  std::vector<double> residual(terms * n, 0.0);
  add_prior(away, prior, residual);
  add_gauge(away, terms, residual);
  {
    const std::size_t size = place(0, rows_);
    std::vector<double> phases(terms * size, 0.0);
    std::vector<double> plane(size);
    for (std::size_t s = 0; s < stars_.size(); ++s) {
      if (!use.empty() && use[s] == 0) continue;
      backward(stars_[s], of(stars_[s], residual_), plane);
      add_terms(stars_[s], plane, terms, phases);
    }
    std::vector<double> slope(terms * n);
    gather(phases, terms, slope);
    for (std::size_t i = 0; i < slope.size(); ++i) residual[i] += slope[i];
  }
  const std::vector<double> scale = diagonal(prior, use);
  std::vector<double> solution(terms * n, 0.0);
  std::vector<double> conditioned(terms * n);
  std::vector<double> product(terms * n);
  const auto precondition = [&] {
    for (std::size_t i = 0; i < conditioned.size(); ++i) conditioned[i] = residual[i] / scale[i];
  };
  precondition();
  std::vector<double> direction = conditioned;
  double rho = std::inner_product(residual.begin(), residual.end(), conditioned.begin(), 0.0);
  const double enough = settings_.tolerance * settings_.tolerance * rho;
  for (int iteration = 0; iteration < settings_.most_iterations && rho > enough && rho > 0.0; ++iteration) {
    multiply(direction, prior, use, product);
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
  std::vector<double> change = psf.coefficients;
  for (std::size_t i = 0; i < present_.coefficients.size(); ++i) change[i] -= present_.coefficients[i];
  const std::vector<double> phases = spread(change, psf.terms());
  std::vector<double> sum(phases.size() / psf.terms());
  std::vector<double> result;
  std::vector<double> pixels;
  for (const Star& star : stars_) {
    pixels.resize(star.pixels());
    combine(star, phases, psf.terms(), sum);
    forward(star, sum, pixels);
    project(star, pixels);
    double chi2 = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double d = residual_[star.offset + i] - pixels[i];
      chi2 += d * d;
    }
    result.push_back(chi2);
  }
  return result;
}

}  // namespace astroid::detail
