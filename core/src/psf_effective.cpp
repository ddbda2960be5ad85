#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr std::size_t kMostTerms = 6;

// Part of the grid that a box of pixels touches, with the polynomials of the field summed up.
struct Section {
  std::span<const double> values;
  std::size_t stride = 0;
  std::int64_t x0 = 0, x1 = 0, y0 = 0, y1 = 0;  // half-open, in samples
};

class EffectivePixelPsf final : public PixelPsf {
 public:
  explicit EffectivePixelPsf(EffectivePsf psf) : psf_(std::move(psf)) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    ASTROID_CHECK_EQ(fractions.size(), box.size());
    if (!usable(centre, fractions)) return;
    const EffectiveAxis x = effective_axis(psf_, centre.x);
    const EffectiveAxis y = effective_axis(psf_, centre.y);
    std::array<double, kMostTerms> phi{};
    field_terms(psf_, centre, phi.data());
    std::vector<double> sums;
    const Section section = cut(x, y, box, phi, sums);
    sample(section, x, y, box, x.weights.weight, y.weights.weight, 1.0, fractions);
  }

  void integrate_gradient(PixelPosition centre, Rectangle box, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    ASTROID_CHECK_EQ(dpdx.size(), box.size());
    ASTROID_CHECK_EQ(dpdy.size(), box.size());
    const bool good = usable(centre, dpdx);
    if (!usable(centre, dpdy) || !good) return;
    const EffectiveAxis x = effective_axis(psf_, centre.x);
    const EffectiveAxis y = effective_axis(psf_, centre.y);
    std::array<double, kMostTerms> phi{};
    field_terms(psf_, centre, phi.data());
    std::vector<double> sums;
    const Section section = cut(x, y, box, phi, sums);
    const double n = psf_.samples_per_pixel;  // a star that moves on moves the pixel back
    sample(section, x, y, box, x.weights.slope, y.weights.weight, -n, dpdx);
    sample(section, x, y, box, x.weights.weight, y.weights.slope, -n, dpdy);
    if (psf_.order == 0) return;
    std::array<double, kMostTerms> along_x{};
    std::array<double, kMostTerms> along_y{};
    slopes_of_terms(centre, along_x, along_y);
    std::vector<double> part(box.size());
    for (const auto& [slopes, result] : {std::pair{&along_x, dpdx}, std::pair{&along_y, dpdy}}) {
      const Section varying = cut(x, y, box, *slopes, sums);
      sample(varying, x, y, box, x.weights.weight, y.weights.weight, 1.0, part);
      for (std::size_t i = 0; i < part.size(); ++i) result[i] += part[i];
    }
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

  [[nodiscard]] std::int64_t first_sample(const EffectiveAxis& axis, int pixel) const {
    return axis.first + static_cast<std::int64_t>(psf_.samples_per_pixel) * (static_cast<std::int64_t>(pixel) - axis.pixel);
  }

  [[nodiscard]] Section cut(const EffectiveAxis& x, const EffectiveAxis& y, const Rectangle& box,
                            const std::array<double, kMostTerms>& phi, std::vector<double>& sums) const {
    Section s;
    const auto side = static_cast<std::int64_t>(psf_.side());
    s.x0 = std::clamp<std::int64_t>(first_sample(x, box.x0), 0, side);
    s.x1 = std::clamp<std::int64_t>(first_sample(x, box.x1() - 1) + 4, s.x0, side);
    s.y0 = std::clamp<std::int64_t>(first_sample(y, box.y0), 0, side);
    s.y1 = std::clamp<std::int64_t>(first_sample(y, box.y1() - 1) + 4, s.y0, side);
    const auto nx = static_cast<std::size_t>(s.x1 - s.x0);
    const auto ny = static_cast<std::size_t>(s.y1 - s.y0);
    const auto width = static_cast<std::size_t>(side);
    sums.assign(nx * ny, 0.0);
    s.stride = nx;
    for (std::size_t k = 0; k < psf_.terms(); ++k) {
      if (phi[k] == 0.0) continue;
      const double* plane = psf_.coefficients.data() + k * psf_.plane_size();
      for (std::size_t j = 0; j < ny; ++j) {
        const double* from = plane + (static_cast<std::size_t>(s.y0) + j) * width + static_cast<std::size_t>(s.x0);
        double* to = sums.data() + j * nx;
        for (std::size_t i = 0; i < nx; ++i) to[i] += phi[k] * from[i];
      }
    }
    s.values = sums;
    return s;
  }

  void sample(const Section& s, const EffectiveAxis& x, const EffectiveAxis& y, const Rectangle& box,
              const double* x_weight, const double* y_weight, double factor, std::span<double> result) const {
    std::ranges::fill(result, 0.0);
    if (s.values.empty()) return;
    const auto width = static_cast<std::size_t>(box.nx);
    const std::int64_t n = psf_.samples_per_pixel;
    const std::int64_t start = first_sample(x, box.x0);
    // Pixels all of whose four samples are on the grid need no tests.
    const auto inner0 = std::clamp<std::int64_t>((s.x0 - start + n - 1) / n, 0, box.nx);
    const auto inner1 = std::clamp<std::int64_t>((s.x1 - 4 - start + n) / n, inner0, box.nx);
    std::vector<double> rows(static_cast<std::size_t>(s.y1 - s.y0) * width, 0.0);
    for (std::int64_t r = s.y0; r < s.y1; ++r) {
      const double* in = s.values.data() + static_cast<std::size_t>(r - s.y0) * s.stride;
      double* out = rows.data() + static_cast<std::size_t>(r - s.y0) * width;
      for (std::int64_t i = 0; i < box.nx; ++i) {
        const std::int64_t first = start + n * i - s.x0;
        double sum = 0.0;
        if (i >= inner0 && i < inner1) {
          const double* c = in + first;
          sum = x_weight[0] * c[0] + x_weight[1] * c[1] + x_weight[2] * c[2] + x_weight[3] * c[3];
        } else {
          for (std::int64_t a = 0; a < 4; ++a)
            if (first + a >= 0 && first + a < static_cast<std::int64_t>(s.stride)) sum += x_weight[a] * in[first + a];
        }
        out[static_cast<std::size_t>(i)] = sum;
      }
    }
    for (int j = 0; j < box.ny; ++j) {
      const std::int64_t first = first_sample(y, box.y0 + j);
      double* out = result.data() + static_cast<std::size_t>(j) * width;
      for (std::int64_t b = 0; b < 4; ++b) {
        if (first + b < s.y0 || first + b >= s.y1) continue;
        const double w = factor * y_weight[b];
        const double* in = rows.data() + static_cast<std::size_t>(first + b - s.y0) * width;
        for (std::size_t i = 0; i < width; ++i) out[i] += w * in[i];
      }
    }
  }

  void slopes_of_terms(PixelPosition place, std::array<double, kMostTerms>& along_x,
                       std::array<double, kMostTerms>& along_y) const {
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
