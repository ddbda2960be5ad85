#include "sub_pixel/band_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"

namespace astroid::detail {

namespace {

using Complex = std::complex<double>;

constexpr std::array<double, 4> kWidths = {1.0, 2.0, 3.0, 5.0};  // px
constexpr std::size_t kPhases = 8;

Complex turn(double turns) {
  const double angle = 2.0 * kPi * (turns - std::floor(turns));
  return {det::cos(angle), det::sin(angle)};
}

// The first is worst where light ends in a step: on the edge of a pixel. The others are no multiples of anything.
double phase_of(std::size_t phase) {
  constexpr double kGolden = 0.61803398874989484820;
  const double turns = kGolden * static_cast<double>(phase);
  return turns - std::floor(turns) - 0.5;
}

std::vector<double> centres(double lower, double upper) {
  std::vector<double> all;
  for (std::size_t phase = 0; phase < kPhases; ++phase)
    for (const double place : {0.0, lower, upper}) all.push_back(place + phase_of(phase));
  return all;
}

double square(double k, double width) {
  return k == 0.0 ? width : det::sin(kPi * k * width) / (kPi * k);
}

}  // namespace

BandError::BandError(PixelPosition lower, PixelPosition upper, const RectangleFlux& exact)
    // One period holds the PSF and a square at each border, so that no light of the next star gets in.
    : period_(std::ceil(std::max(upper.x - lower.x, upper.y - lower.y)) + kWidths.back() + 2.0),
      columns_(centres(lower.x, upper.x)),
      lines_(centres(lower.y, upper.y)) {
  for (const double x : columns_)
    for (const double width : kWidths)
      for (const double y : lines_)
        exact_.push_back(exact({x - 0.5 * width, y - 0.5 * width}, {x + 0.5 * width, y + 0.5 * width}));
}

double BandError::of(const PsfSpectrum& spectrum, double band) const {
  // Sums over frequencies up to `most` reach half a step farther: no farther than the band.
  const auto most = static_cast<std::size_t>(std::max(0.0, std::floor(band * period_ - 0.5)));
  std::vector<double> kx(most + 1);
  std::vector<double> ky(2 * most + 1);
  for (std::size_t i = 0; i <= most; ++i) kx[i] = static_cast<double>(i) / period_;
  for (std::size_t i = 0; i <= 2 * most; ++i) ky[i] = (static_cast<double>(i) - static_cast<double>(most)) / period_;
  std::vector<Complex> h(kx.size() * ky.size());
  spectrum.sample(kx, ky, h);
  std::vector<Complex> ramps;
  for (const double y : lines_)
    for (const double k : ky) ramps.push_back(turn(k * y));
  double worst = 0.0;
  std::vector<Complex> rows(ky.size());
  std::vector<Complex> weight(kx.size());
  auto exact = exact_.begin();
  for (const double x : columns_) {
    for (const double width : kWidths) {
      std::vector<double> square_y(ky.size());
      std::ranges::transform(ky, square_y.begin(), [&](double k) { return square(k, width); });
      for (std::size_t i = 0; i < kx.size(); ++i)
        weight[i] = (i == 0 ? 1.0 : 2.0) * square(kx[i], width) * turn(kx[i] * x);
      // The half plane kx < 0 mirrors the other: twice the real part of the sum over ky.
      for (std::size_t q = 0; q < ky.size(); ++q)
        rows[q] = std::inner_product(weight.begin(), weight.end(),
                                     h.begin() + static_cast<std::ptrdiff_t>(q * kx.size()), Complex{});
      for (std::size_t r = 0; r < lines_.size(); ++r) {
        const Complex* ramp = &ramps[r * ky.size()];
        double flux = 0.0;
        for (std::size_t q = 0; q < ky.size(); ++q) flux += (rows[q] * ramp[q]).real() * square_y[q];
        worst = std::max(worst, std::abs(flux / (period_ * period_) - *exact++));
      }
    }
  }
  return worst;
}

}  // namespace astroid::detail
