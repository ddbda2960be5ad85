#include "psf/psf_gauge.hpp"

#include <array>
#include <span>
#include <vector>

#include "astroid/core/math.hpp"
#include "small_matrix.hpp"

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

// Those of the terms at a place.
std::vector<double> plane_at(const EffectivePsf& psf, PixelPosition place) {
  std::array<double, 6> phi{};
  field_terms(psf, place, phi.data());
  const std::size_t n = psf.plane_size();
  std::vector<double> plane(n, 0.0);
  for (std::size_t k = 0; k < psf.terms(); ++k)
    for (std::size_t i = 0; i < n; ++i) plane[i] += phi[k] * psf.coefficients[k * n + i];
  return plane;
}

void normalise(std::vector<double>& plane, const EffectivePsf& psf, double sigma) {
  const double unit = static_cast<double>(psf.samples_per_pixel) * psf.samples_per_pixel;
  std::vector<double> along_x;
  std::vector<double> along_y;
  constexpr int kPasses = 4;  // shifts are to first order
  for (int pass = 0; pass < kPasses; ++pass) {
    slopes_of(plane, psf, along_x, along_y);
    const Moments m = moments_of(plane, psf, sigma);
    const double x = m.x / moments_of(along_x, psf, sigma).x;
    const double y = m.y / moments_of(along_y, psf, sigma).y;
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] -= x * along_x[i] + y * along_y[i];
    const double scale = unit / moments_of(plane, psf, sigma).sum;
    for (double& value : plane) value *= scale;
  }
}

}  // namespace

std::array<std::vector<double>, 3> gauge_weights(const EffectivePsf& psf, double sigma) {
  const std::vector<double> first(psf.coefficients.begin(),
                                  psf.coefficients.begin() + static_cast<std::ptrdiff_t>(psf.plane_size()));
  std::vector<double> along_x;
  std::vector<double> along_y;
  slopes_of(first, psf, along_x, along_y);
  const double slope_x = moments_of(along_x, psf, sigma).x;
  const double slope_y = moments_of(along_y, psf, sigma).y;
  const double step = 1.0 / psf.samples_per_pixel;
  std::array<std::vector<double>, 3> weights;
  for (int j = -psf.half; j <= psf.half; ++j)
    for (int i = -psf.half; i <= psf.half; ++i) {
      const double x = i * step;
      const double y = j * step;
      const double window = det::exp(-0.5 * (x * x + y * y) / (sigma * sigma));
      weights[0].push_back(step * step);
      weights[1].push_back(window * x / slope_x);
      weights[2].push_back(window * y / slope_y);
    }
  return weights;
}

void fix_gauge(EffectivePsf& psf, double sigma) {
  // Planes at places of a grid over the field are put right one by one, and the terms fitted to them.
  const std::size_t n = psf.plane_size();
  const std::size_t terms = psf.terms();
  constexpr int kPlaces = 5;  // along each axis
  const int places = psf.order == 0 ? 1 : kPlaces;
  std::vector<double> matrix(terms * terms, 0.0);
  std::vector<double> right(terms * n, 0.0);
  for (int j = 0; j < places; ++j)
    for (int i = 0; i < places; ++i) {
      const auto at = [places](int k) { return places == 1 ? 0.0 : 2.0 * k / (places - 1) - 1.0; };
      const PixelPosition place{psf.field_centre.x + at(i) * psf.field_scale.x,
                                psf.field_centre.y + at(j) * psf.field_scale.y};
      std::vector<double> plane = plane_at(psf, place);
      normalise(plane, psf, sigma);
      std::array<double, 6> phi{};
      field_terms(psf, place, phi.data());
      for (std::size_t k = 0; k < terms; ++k) {
        for (std::size_t l = 0; l <= k; ++l) matrix[k * terms + l] += phi[k] * phi[l];
        for (std::size_t s = 0; s < n; ++s) right[k * n + s] += phi[k] * plane[s];
      }
    }
  constexpr double kLeastShare = 1e-12;
  cholesky(matrix, terms, kLeastShare);
  std::array<double, 6> v{};
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t k = 0; k < terms; ++k) v[k] = right[k * n + s];
    solve_lower(matrix, terms, v);
    for (std::size_t k = terms; k-- > 0;) {
      for (std::size_t l = k + 1; l < terms; ++l) v[k] -= matrix[l * terms + k] * v[l];
      v[k] /= matrix[k * terms + k];
    }
    for (std::size_t k = 0; k < terms; ++k) psf.coefficients[k * n + s] = v[k];
  }
}

}  // namespace astroid::detail
