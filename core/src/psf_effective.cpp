#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr std::size_t kMostTerms = 6;

using Terms = std::array<double, kMostTerms>;

// The pixels of a box that the grid reaches, and where the splines of the first of them begin.
struct Reached {
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;  // half-open, from the box's first pixel
  int sample_x = 0, sample_y = 0;      // on the padded grid
  [[nodiscard]] std::size_t nx() const { return static_cast<std::size_t>(x1 - x0); }
  [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
};

class EffectivePixelPsf final : public PixelPsf {
 public:
  explicit EffectivePixelPsf(EffectivePsf psf)
      : psf_(std::move(psf)),
        rows_(psf_.side() + 2 * kPad),
        run_(static_cast<std::size_t>((rows_ + psf_.samples_per_pixel - 1) / psf_.samples_per_pixel)),
        size_(place(0, rows_)) {
    phases_.assign(psf_.terms() * size_, 0.0);
    std::size_t i = 0;
    for (std::size_t k = 0; k < psf_.terms(); ++k)
      for (int y = 0; y < psf_.side(); ++y)
        for (int x = 0; x < psf_.side(); ++x) phases_[k * size_ + place(kPad + x, kPad + y)] = psf_.coefficients[i++];
  }

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    if (!usable(centre, fractions)) return;
    const EffectiveAxis x = effective_axis(psf_, centre.x);
    const EffectiveAxis y = effective_axis(psf_, centre.y);
    const Reached reached = reach(x, y, box);
    if (reached.empty()) return;
    Terms phi{};
    field_terms(psf_, centre, phi.data());
    std::vector<double> scratch;
    const double* plane = combine(phi, reached, scratch);
    sample(plane, reached, box, x.weights.weight, y.weights.weight, 1.0, fractions);
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    const bool good = usable(centre, dpdx);
    if (!usable(centre, dpdy) || !good) return;
    const EffectiveAxis x = effective_axis(psf_, centre.x);
    const EffectiveAxis y = effective_axis(psf_, centre.y);
    const Reached reached = reach(x, y, box);
    if (reached.empty()) return;
    Terms phi{};
    field_terms(psf_, centre, phi.data());
    std::vector<double> scratch;
    const double* plane = combine(phi, reached, scratch);
    const double n = psf_.samples_per_pixel;  // a star that moves on moves the pixel back
    sample(plane, reached, box, x.weights.slope, y.weights.weight, -n, dpdx);
    sample(plane, reached, box, x.weights.weight, y.weights.slope, -n, dpdy);
    if (psf_.order == 0) return;
    Terms along_x{};
    Terms along_y{};
    slopes_of_terms(centre, along_x, along_y);
    sample(combine(along_x, reached, scratch), reached, box, x.weights.weight, y.weights.weight, 1.0, dpdx);
    sample(combine(along_y, reached, scratch), reached, box, x.weights.weight, y.weights.weight, 1.0, dpdy);
  }

  [[nodiscard]] double stamp_half_width(double /*lost*/) const override {
    constexpr double kSplineReach = 2.0;  // samples
    return (psf_.half + kSplineReach) / psf_.samples_per_pixel + 0.5;
  }
  [[nodiscard]] double approximation_error() const override { return 0.0; }
  [[nodiscard]] std::vector<PixelPosition> places() const override {
    const auto [cx, cy] = psf_.field_centre;
    const auto [sx, sy] = psf_.field_scale;
    if (psf_.order == 0) return {{cx, cy}};
    return {{cx, cy}, {cx - sx, cy - sy}, {cx + sx, cy - sy}, {cx - sx, cy + sy}, {cx + sx, cy + sy}};
  }
  [[nodiscard]] std::string description() const override {
    constexpr std::array kOrders{"the same everywhere", "varying linearly over the field",
                                 "varying quadratically over the field"};
    return fmt::format("effective PSF of {} samples per pixel within {:.3g} px, {}, of unit flux there",
                       psf_.samples_per_pixel, static_cast<double>(psf_.half) / psf_.samples_per_pixel,
                       kOrders[static_cast<std::size_t>(psf_.order)]);
  }

 private:
  static bool usable(PixelPosition centre, std::span<double> values) {
    constexpr double kFarthest = 1e9;  // px
    const bool finite = std::isfinite(centre.x) && std::isfinite(centre.y);
    std::ranges::fill(values, finite ? 0.0 : std::numeric_limits<double>::quiet_NaN());
    return finite && std::abs(centre.x) < kFarthest && std::abs(centre.y) < kFarthest;
  }

  // A pixel of the grid's rim has splines beyond it: with zeros there it needs no tests.
  static constexpr int kPad = 4;

  [[nodiscard]] std::size_t place(int x, int y) const {
    const int step = psf_.samples_per_pixel;
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(step) + static_cast<std::size_t>(x % step)) * run_ +
           static_cast<std::size_t>(x / step);
  }

  // Pixels first … end of n, of those whose first spline is number start + step i, that have a spline on the grid.
  [[nodiscard]] std::pair<int, int> reach_of(const EffectiveAxis& axis, int first_pixel, int n, int& sample) const {
    const std::int64_t step = psf_.samples_per_pixel;
    const std::int64_t start = axis.first + step * (static_cast<std::int64_t>(first_pixel) - axis.pixel);
    const std::int64_t below = -3 - start;  // at least so many samples on
    const std::int64_t above = psf_.side() - 1 - start;
    const auto up = [step](std::int64_t v) { return v > 0 ? (v + step - 1) / step : std::int64_t{0}; };
    const std::int64_t begin = std::min<std::int64_t>(up(below), n);
    const std::int64_t end = above < 0 ? begin : std::clamp<std::int64_t>(above / step + 1, begin, n);
    sample = static_cast<int>(kPad + (begin < end ? start + step * begin : 0));
    return {static_cast<int>(begin), static_cast<int>(end)};
  }

  [[nodiscard]] Reached reach(const EffectiveAxis& x, const EffectiveAxis& y, const Rectangle& box) const {
    Reached r;
    std::tie(r.x0, r.x1) = reach_of(x, box.x0, box.nx, r.sample_x);
    std::tie(r.y0, r.y1) = reach_of(y, box.y0, box.ny, r.sample_y);
    return r;
  }

  [[nodiscard]] int last_row(const Reached& r) const {
    return r.sample_y + psf_.samples_per_pixel * (r.y1 - r.y0 - 1) + 4;
  }

  // The plane of coefficients at a place of the field: that of the file, or a sum in `scratch`.
  const double* combine(const Terms& phi, const Reached& reached, std::vector<double>& scratch) const {
    if (psf_.order == 0) return phases_.data();
    scratch.resize(size_);
    const int step = psf_.samples_per_pixel;
    const auto first = static_cast<std::size_t>(reached.sample_x / step);
    const int last = reached.sample_x + step * (reached.x1 - reached.x0 - 1) + 3;
    const std::size_t length = static_cast<std::size_t>(last / step) + 1 - first;
    for (int row = reached.sample_y; row < last_row(reached); ++row)
      for (int phase = 0; phase < step; ++phase) {
        const std::size_t begin = place(phase, row) + first;
        double* sum = scratch.data() + begin;
        std::fill_n(sum, length, 0.0);
        for (std::size_t k = 0; k < psf_.terms(); ++k) {
          const double* c = phases_.data() + k * size_ + begin;
          for (std::size_t i = 0; i < length; ++i) sum[i] += phi[k] * c[i];
        }
      }
    return scratch.data();
  }

  // Adds the splines' sum in every pixel that the grid reaches.
  void sample(const double* plane, const Reached& reached, const Rectangle& box, const double* x_weight,
              const double* y_weight, double factor, std::span<double> result) const {
    const std::size_t n = reached.nx();
    const int step = psf_.samples_per_pixel;
    const int first = reached.sample_y;
    std::vector<double> rows(static_cast<std::size_t>(last_row(reached) - first) * n);
    for (int r = first; r < last_row(reached); ++r) {
      double* out = rows.data() + static_cast<std::size_t>(r - first) * n;
      const double* c0 = plane + place(reached.sample_x, r);
      const double* c1 = plane + place(reached.sample_x + 1, r);
      const double* c2 = plane + place(reached.sample_x + 2, r);
      const double* c3 = plane + place(reached.sample_x + 3, r);
      for (std::size_t i = 0; i < n; ++i)
        out[i] = x_weight[0] * c0[i] + x_weight[1] * c1[i] + x_weight[2] * c2[i] + x_weight[3] * c3[i];
    }
    for (int j = reached.y0; j < reached.y1; ++j) {
      double* out = result.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(box.nx) + reached.x0;
      const double* in = rows.data() + static_cast<std::size_t>(step * (j - reached.y0)) * n;
      for (std::size_t i = 0; i < n; ++i)
        out[i] += factor * (y_weight[0] * in[i] + y_weight[1] * in[n + i] + y_weight[2] * in[2 * n + i] +
                            y_weight[3] * in[3 * n + i]);
    }
  }

  void slopes_of_terms(PixelPosition place, Terms& along_x, Terms& along_y) const {
    const double u = (place.x - psf_.field_centre.x) / psf_.field_scale.x;
    const double v = (place.y - psf_.field_centre.y) / psf_.field_scale.y;
    const double du = std::abs(u) < 1.0 ? 1.0 / psf_.field_scale.x : 0.0;
    const double dv = std::abs(v) < 1.0 ? 1.0 / psf_.field_scale.y : 0.0;
    const double cu = std::clamp(u, -1.0, 1.0);
    const double cv = std::clamp(v, -1.0, 1.0);
    along_x = {0.0, du, 0.0, 2.0 * cu * du, cv * du, 0.0};
    along_y = {0.0, 0.0, dv, 0.0, cu * dv, 2.0 * cv * dv};
  }

  EffectivePsf psf_;
  // Samples that are a whole number of pixels apart are side by side: a row of the padded grid is samples_per_pixel
  // runs of run_ samples.
  int rows_;
  std::size_t run_;
  std::size_t size_;
  std::vector<double> phases_;
};

}  // namespace

CubicWeights cubic_weights(double t) {
  const double s = 1.0 - t;
  CubicWeights w;
  w.weight[0] = s * s * s / 6.0;
  w.weight[1] = 2.0 / 3.0 - t * t * (1.0 - 0.5 * t);
  w.weight[2] = 2.0 / 3.0 - s * s * (1.0 - 0.5 * s);
  w.weight[3] = t * t * t / 6.0;
  w.slope[0] = -0.5 * s * s;
  w.slope[1] = t * (1.5 * t - 2.0);
  w.slope[2] = s * (2.0 - 1.5 * s);
  w.slope[3] = 0.5 * t * t;
  return w;
}

EffectiveAxis effective_axis(const EffectivePsf& psf, double star) {
  EffectiveAxis axis;
  const double nearest = std::floor(star + 0.5);
  const double offset = -psf.samples_per_pixel * (star - nearest);
  const double below = std::floor(offset);
  axis.pixel = static_cast<int>(nearest);
  axis.first = psf.half + static_cast<int>(below) - 1;
  axis.weights = cubic_weights(offset - below);
  return axis;
}

void field_terms(const EffectivePsf& psf, PixelPosition place, double* phi) {
  const double u = std::clamp((place.x - psf.field_centre.x) / psf.field_scale.x, -1.0, 1.0);
  const double v = std::clamp((place.y - psf.field_centre.y) / psf.field_scale.y, -1.0, 1.0);
  const std::array<double, kMostTerms> all{1.0, u, v, u * u, u * v, v * v};
  std::copy_n(all.begin(), psf.terms(), phi);
}

void spline_values_of(std::vector<double>& plane, int side) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<double> line(n);
  const auto filter = [&](double* start, std::size_t step) {
    for (std::size_t i = 0; i < n; ++i) {
      const double left = i > 0 ? start[(i - 1) * step] : 0.0;
      const double right = i + 1 < n ? start[(i + 1) * step] : 0.0;
      line[i] = (left + 4.0 * start[i * step] + right) / 6.0;
    }
    for (std::size_t i = 0; i < n; ++i) start[i * step] = line[i];
  };
  for (std::size_t j = 0; j < n; ++j) filter(plane.data() + j * n, 1);
  for (std::size_t i = 0; i < n; ++i) filter(plane.data() + i, n);
}

void spline_coefficients_of(std::vector<double>& plane, int side) {
  const auto n = static_cast<std::size_t>(side);
  // The tridiagonal system 1/6, 4/6, 1/6 by elimination; its factors are the same for every line.
  std::vector<double> pivot(n, 4.0);
  for (std::size_t i = 1; i < n; ++i) pivot[i] = 4.0 - 1.0 / pivot[i - 1];
  const auto solve = [&](double* start, std::size_t step) {
    for (std::size_t i = 0; i < n; ++i) start[i * step] *= 6.0;
    for (std::size_t i = 1; i < n; ++i) start[i * step] -= start[(i - 1) * step] / pivot[i - 1];
    start[(n - 1) * step] /= pivot[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) start[i * step] = (start[i * step] - start[(i + 1) * step]) / pivot[i];
  };
  for (std::size_t j = 0; j < n; ++j) solve(plane.data() + j * n, 1);
  for (std::size_t i = 0; i < n; ++i) solve(plane.data() + i, n);
}

std::shared_ptr<const PixelPsf> make_effective_psf(EffectivePsf psf) {
  const bool good = psf.samples_per_pixel > 0 && psf.half > 0 && psf.order >= 0 && psf.order <= 2 &&
                    psf.field_scale.x > 0.0 && psf.field_scale.y > 0.0 &&
                    psf.coefficients.size() == psf.terms() * psf.plane_size() &&
                    std::ranges::all_of(psf.coefficients, [](double c) { return std::isfinite(c); });
  if (!good)
    throw InputError(Problem{.parameter = "effective PSF",
                             .value = fmt::format("{} coefficients of {} samples per pixel, order {}",
                                                  psf.coefficients.size(), psf.samples_per_pixel, psf.order),
                             .expected = "finite coefficients of a square grid for every term of order 0 to 2",
                             .message = "the PSF cannot be made"});
  return std::make_shared<const EffectivePixelPsf>(std::move(psf));
}

}  // namespace astroid
