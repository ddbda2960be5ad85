#include "astroid/core/pixel_response.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/statistics/sums.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

using Complex = std::complex<double>;

// sum over terms of product of an axis' profile with itself, divided by the mean.
PixelResponse from_profile(int cells, double constant, const std::vector<double>& profile) {
  PixelResponse response{.cells = cells, .sensitivity = {}};
  for (const double y : profile)
    for (const double x : profile) response.sensitivity.push_back(constant + (1.0 - constant) * (x * y));
  const double mean = pairwise_sum(response.sensitivity) / static_cast<double>(response.sensitivity.size());
  for (double& value : response.sensitivity) value /= mean;
  return response;
}

// Means over the cells of a profile whose integral from the centre of the pixel is known.
std::vector<double> cell_means(int cells, const std::function<double(double)>& integral) {
  std::vector<double> means;
  for (int i = 0; i < cells; ++i) {
    const double lower = static_cast<double>(i) / cells - 0.5;
    const double upper = static_cast<double>(i + 1) / cells - 0.5;
    means.push_back((integral(upper) - integral(lower)) * cells);
  }
  return means;
}

PixelResponse uniform(int cells) {
  ASTROID_CHECK_LT(0, cells);
  return {cells, std::vector<double>(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), 1.0)};
}

double sinc(double x) {
  return x == 0.0 ? 1.0 : det::sin(kPi * x) / (kPi * x);
}

}  // namespace

bool PixelResponse::is_uniform() const {
  return std::ranges::all_of(sensitivity, [](double s) { return s == 1.0; });
}

double PixelResponse::depth() const {
  double largest = 0.0;
  for (const double s : sensitivity) largest = std::max(largest, std::abs(s - 1.0));
  return largest;
}

PixelResponse edge_response(int cells, double depth, double width) {
  if (depth == 0.0 || width == 0.0) return uniform(cells);
  const double inside = 0.5 - width;
  // Of the box that is 1 inside and 0 in the border.
  return from_profile(cells, 1.0 - depth,
                      cell_means(cells, [inside](double x) { return std::clamp(x, -inside, inside); }));
}

PixelResponse cosine_response(int cells, double depth) {
  if (depth == 0.0) return uniform(cells);
  return from_profile(cells, 0.0, cell_means(cells, [depth](double x) {
                        return x - 0.5 * depth * (x - det::sin(2.0 * kPi * x) / (2.0 * kPi));
                      }));
}

PixelResponse gaussian_response(int cells, double depth) {
  if (depth == 0.0) return uniform(cells);
  constexpr double kEdge = 0.5;
  const double per_root_two_sigma = det::sqrt(-det::log1p(-depth)) / kEdge;
  return from_profile(cells, 0.0,
                      cell_means(cells, [per_root_two_sigma](double x) { return det::erf(x * per_root_two_sigma); }));
}

void sample_response(const PixelResponse& response, std::span<const double> kx, std::span<const double> ky,
                     std::span<Complex> values) {
  ASTROID_CHECK_EQ(values.size(), kx.size() * ky.size());
  const int cells = response.cells;
  const auto count = static_cast<std::size_t>(cells);
  // A cell is a box of width 1/cells about its centre.
  const auto ramp = [&](double k, std::vector<Complex>& phases) {
    phases.resize(count);
    const double box = sinc(k / cells) / cells;
    for (int i = 0; i < cells; ++i) {
      const double angle = -2.0 * kPi * k * ((i + 0.5) / cells - 0.5);
      phases[static_cast<std::size_t>(i)] = {box * det::cos(angle), box * det::sin(angle)};
    }
  };
  std::vector<Complex> phases;
  std::vector<Complex> rows(count * kx.size());
  for (std::size_t i = 0; i < kx.size(); ++i) {
    ramp(kx[i], phases);
    for (std::size_t row = 0; row < count; ++row) {
      Complex sum;
      for (std::size_t column = 0; column < count; ++column)
        sum += response.sensitivity[row * count + column] * phases[column];
      rows[row * kx.size() + i] = sum;
    }
  }
  std::ranges::fill(values, Complex{});
  for (std::size_t q = 0; q < ky.size(); ++q) {
    ramp(ky[q], phases);
    for (std::size_t row = 0; row < count; ++row)
      for (std::size_t i = 0; i < kx.size(); ++i) values[q * kx.size() + i] += phases[row] * rows[row * kx.size() + i];
  }
}

}  // namespace astroid
