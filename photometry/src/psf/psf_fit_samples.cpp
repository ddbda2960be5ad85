// The splines of an effective PSF in the pixels of its stars, and back: the matrix of the fit and its transpose.
#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "psf/psf_fit.hpp"

namespace astroid::detail {

void PsfFit::project(const Star& star, std::span<double> pixels) const {
  const std::size_t n = pixels.size();
  for (std::size_t a = 0; a < kFree; ++a) {
    const double* u = basis_.data() + kFree * star.offset + a * n;
    const double dot = std::inner_product(pixels.begin(), pixels.end(), u, 0.0);
    for (std::size_t k = 0; k < n; ++k) pixels[k] -= dot * u[k];
  }
}

std::span<const double> PsfFit::of(const Star& star, const std::vector<double>& values) const {
  return std::span(values).subspan(star.offset, star.pixels());
}

std::size_t PsfFit::place(int x, int y) const {
  const int step = present_.samples_per_pixel;
  const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(step) + static_cast<std::size_t>(x % step);
  return row * run_ + static_cast<std::size_t>(x / step);
}

std::vector<double> PsfFit::spread(std::span<const double> coefficients, std::size_t terms) const {
  const std::size_t size = place(0, rows_);
  std::vector<double> phases(terms * size, 0.0);
  std::size_t i = 0;
  for (std::size_t k = 0; k < terms; ++k)
    for (int y = 0; y < present_.side(); ++y)
      for (int x = 0; x < present_.side(); ++x) phases[k * size + place(pad_ + x, pad_ + y)] = coefficients[i++];
  return phases;
}

void PsfFit::gather(std::span<const double> phases, std::size_t terms, std::span<double> coefficients) const {
  const std::size_t size = place(0, rows_);
  std::size_t i = 0;
  for (std::size_t k = 0; k < terms; ++k)
    for (int y = 0; y < present_.side(); ++y)
      for (int x = 0; x < present_.side(); ++x) coefficients[i++] = phases[k * size + place(pad_ + x, pad_ + y)];
}

void PsfFit::combine(const Star& star, std::span<const double> phases, std::size_t terms, std::span<double> sum) const {
  const std::size_t size = sum.size();
  for_each_run(star, [&](std::size_t begin, std::size_t length) {
    double* out = sum.data() + begin;
    std::copy_n(phases.data() + begin, length, out);
    for (std::size_t k = 1; k < terms; ++k) {
      const double* c = phases.data() + k * size + begin;
      for (std::size_t i = 0; i < length; ++i) out[i] += star.phi[k] * c[i];
    }
  });
}

void PsfFit::add_terms(const Star& star, std::span<double> sum, std::size_t terms, std::span<double> phases) const {
  const std::size_t size = sum.size();
  for_each_run(star, [&](std::size_t begin, std::size_t length) {
    double* in = sum.data() + begin;
    for (std::size_t k = 0; k < terms; ++k) {
      double* c = phases.data() + k * size + begin;
      for (std::size_t i = 0; i < length; ++i) c[i] += star.phi[k] * in[i];
    }
    std::fill_n(in, length, 0.0);
  });
}

void PsfFit::forward(const Star& star, std::span<const double> phases, std::span<double> pixels) const {
  const int step = present_.samples_per_pixel;
  const auto side = static_cast<std::size_t>(star.side);
  const int first_row = star.start_y;
  const int last_row = star.start_y + step * (star.side - 1) + 4;
  std::vector<double>& rows = scratch_;
  rows.resize(static_cast<std::size_t>(last_row - first_row) * side);
  for (int r = first_row; r < last_row; ++r) {
    double* out = rows.data() + static_cast<std::size_t>(r - first_row) * side;
    const double* c0 = phases.data() + place(star.start_x, r);
    const double* c1 = phases.data() + place(star.start_x + 1, r);
    const double* c2 = phases.data() + place(star.start_x + 2, r);
    const double* c3 = phases.data() + place(star.start_x + 3, r);
    for (std::size_t i = 0; i < side; ++i)
      out[i] = star.wx[0] * c0[i] + star.wx[1] * c1[i] + star.wx[2] * c2[i] + star.wx[3] * c3[i];
  }
  const double* root = root_weight_.data() + star.offset;
  std::array<double, 4> w{};
  for (std::size_t b = 0; b < 4; ++b) w[b] = star.flux * star.wy[b];
  for (std::size_t j = 0; j < side; ++j) {
    double* out = pixels.data() + j * side;
    const double* in = rows.data() + static_cast<std::size_t>(step) * j * side;
    for (std::size_t i = 0; i < side; ++i)
      out[i] =
          root[j * side + i] * (w[0] * in[i] + w[1] * in[side + i] + w[2] * in[2 * side + i] + w[3] * in[3 * side + i]);
  }
}

void PsfFit::backward(const Star& star, std::span<const double> pixels, std::span<double> phases) const {
  const int step = present_.samples_per_pixel;
  const auto side = static_cast<std::size_t>(star.side);
  const int first_row = star.start_y;
  const int last_row = star.start_y + step * (star.side - 1) + 4;
  std::vector<double>& rows = scratch_;
  rows.assign(static_cast<std::size_t>(last_row - first_row) * side, 0.0);
  const double* root = root_weight_.data() + star.offset;
  for (std::size_t j = 0; j < side; ++j) {
    const double* in = pixels.data() + j * side;
    for (std::size_t b = 0; b < 4; ++b) {
      const double w = star.flux * star.wy[b];
      double* out = rows.data() + (static_cast<std::size_t>(step) * j + b) * side;
      for (std::size_t i = 0; i < side; ++i) out[i] += w * root[j * side + i] * in[i];
    }
  }
  for (int r = first_row; r < last_row; ++r) {
    const double* in = rows.data() + static_cast<std::size_t>(r - first_row) * side;
    for (int a = 0; a < 4; ++a) {
      double* c = phases.data() + place(star.start_x + a, r);
      const double w = star.wx[static_cast<std::size_t>(a)];
      for (std::size_t i = 0; i < side; ++i) c[i] += w * in[i];
    }
  }
}

}  // namespace astroid::detail
