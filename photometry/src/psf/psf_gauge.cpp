#include "psf/psf_gauge.hpp"

#include <span>
#include <vector>

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

struct Moments {
  double sum = 0.0, x = 0.0, y = 0.0;
};

// Sum of a plane, and its first moments under the window, px.
Moments moments_of(std::span<const double> plane, const EffectivePsf& psf, double sigma) {
  Moments m;
  const double step = 1.0 / psf.samples_per_pixel;
  std::size_t k = 0;
  for (int j = -psf.half; j <= psf.half; ++j) {
    for (int i = -psf.half; i <= psf.half; ++i, ++k) {
      const double x = i * step;
      const double y = j * step;
      const double window = det::exp(-0.5 * (x * x + y * y) / (sigma * sigma));
      m.sum += plane[k];
      m.x += window * x * plane[k];
      m.y += window * y * plane[k];
    }
  }
  return m;
}

// d/dx and d/dy of a plane, 1/px.
void slopes_of(std::span<const double> plane, const EffectivePsf& psf, std::vector<double>& along_x,
               std::vector<double>& along_y) {
  const auto width = static_cast<std::size_t>(psf.side());
  const double scale = 0.5 * psf.samples_per_pixel;
  along_x.assign(plane.size(), 0.0);
  along_y.assign(plane.size(), 0.0);
  for (std::size_t j = 0; j < width; ++j)
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t k = j * width + i;
      along_x[k] = scale * ((i + 1 < width ? plane[k + 1] : 0.0) - (i > 0 ? plane[k - 1] : 0.0));
      along_y[k] = scale * ((j + 1 < width ? plane[k + width] : 0.0) - (j > 0 ? plane[k - width] : 0.0));
    }
}

}  // namespace

void fix_gauge(EffectivePsf& psf, double sigma) {
  const std::size_t n = psf.plane_size();
  std::vector<double> along_x;
  std::vector<double> along_y;
  constexpr int kPasses = 4;  // shifts are to first order
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<double> first(psf.coefficients.begin(), psf.coefficients.begin() + static_cast<std::ptrdiff_t>(n));
    slopes_of(first, psf, along_x, along_y);
    const double slope_x = moments_of(along_x, psf, sigma).x;
    const double slope_y = moments_of(along_y, psf, sigma).y;
    for (std::size_t k = 0; k < psf.terms(); ++k) {
      const std::span<double> plane = std::span(psf.coefficients).subspan(k * n, n);
      const Moments m = moments_of(plane, psf, sigma);
      for (std::size_t i = 0; i < n; ++i) plane[i] -= m.x / slope_x * along_x[i] + m.y / slope_y * along_y[i];
    }
    const double total = moments_of(std::span(psf.coefficients).first(n), psf, sigma).sum;
    const double unit = static_cast<double>(psf.samples_per_pixel) * psf.samples_per_pixel;
    for (std::size_t i = 0; i < n; ++i) psf.coefficients[i] *= unit / total;
    for (std::size_t k = 1; k < psf.terms(); ++k) {
      const std::span<double> plane = std::span(psf.coefficients).subspan(k * n, n);
      const double sum = moments_of(plane, psf, sigma).sum;
      for (std::size_t i = 0; i < n; ++i) plane[i] -= sum / unit * psf.coefficients[i];
    }
  }
}

}  // namespace astroid::detail
