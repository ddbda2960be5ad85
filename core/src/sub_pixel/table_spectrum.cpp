#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/psf_spectrum.hpp"
#include "astroid/core/units.hpp"
#include "flux_spline.hpp"
#include "sub_pixel/band_error.hpp"

namespace astroid {

namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 6.28318530717958647692528676655900577;

Complex turn(double turns) {
  const double angle = kTwoPi * (turns - std::floor(turns));
  return {det::cos(angle), det::sin(angle)};
}

// Transforms of the powers t^0, t^1, t^2 on [0, 1], at frequency f.
std::array<Complex, 3> power_transforms(double f) {
  const Complex z(0.0, -kTwoPi * f);
  std::array<Complex, 3> m;
  constexpr double kSmall = 2.0;  // |z| below which the closed forms cancel
  if (std::abs(z) < kSmall) {
    // Sum of z^n / (n! (n + m + 1)).
    constexpr int kTerms = 28;
    for (std::size_t p = 0; p < m.size(); ++p) {
      Complex power(1.0);
      for (int n = 0; n < kTerms; ++n) {
        m[p] += power / (static_cast<double>(n) + static_cast<double>(p) + 1.0);
        power *= z / (n + 1.0);
      }
    }
    return m;
  }
  const Complex end = turn(-f);
  m[0] = (end - 1.0) / z;
  m[1] = (end - m[0]) / z;
  m[2] = (end - 2.0 * m[1]) / z;
  return m;
}

// Transforms, at frequency f in cycles a sample, of the quadratic B-splines whose mixed coefficients are differences of
// neighbouring ones of the running integral, cut off at the table's ends: basis j - 1/2 for j = 0 … n + 1.
void basis_transforms(double f, std::vector<Complex>& basis) {
  const std::size_t n = basis.size() - 2;
  const auto m = power_transforms(f);
  // The three pieces of a quadratic B-spline: t²/2, 1/2 + t - t² and (1 - t)²/2.
  const Complex rise = 0.5 * m[2];
  const Complex top = 0.5 * m[0] + m[1] - m[2];
  const Complex fall = 0.5 * m[0] - m[1] + 0.5 * m[2];
  std::ranges::fill(basis, Complex{});
  for (std::size_t i = 0; i < n; ++i) {
    const Complex phase = turn(-f * static_cast<double>(i));
    basis[i] += fall * phase;
    basis[i + 1] += top * phase;
    basis[i + 2] += rise * phase;
  }
}

class TableSpectrum final : public PsfSpectrum {
 public:
  explicit TableSpectrum(const PsfTable& table) : spline_(table), nx_(spline_.nx() + 2), ny_(spline_.ny() + 2) {
    // Mixed differences of the coefficients of the running integral.
    const auto c = spline_.coefficients();
    const std::size_t stride = nx_ + 1;
    differences_.resize(nx_ * ny_);
    for (std::size_t j = 0; j < ny_; ++j)
      for (std::size_t i = 0; i < nx_; ++i)
        differences_[j * nx_ + i] =
            (c[(j + 1) * stride + i + 1] - c[(j + 1) * stride + i]) - (c[j * stride + i + 1] - c[j * stride + i]);
    band_error_.emplace(spline_.lower(), spline_.upper(),
                        [this](PixelPosition lower, PixelPosition upper) { return spline_.flux(lower, upper); });
  }

  void sample(std::span<const double> kx, std::span<const double> ky, std::span<Complex> values) const override {
    ASTROID_CHECK_EQ(values.size(), kx.size() * ky.size());
    const double scale = 1.0 / spline_.samples_per_pixel();
    // Along x first: rows of the differences, each a number per kx.
    std::vector<Complex> along_x(ny_ * kx.size());
    std::vector<Complex> basis(nx_);
    const PixelPosition origin = spline_.lower();
    for (std::size_t i = 0; i < kx.size(); ++i) {
      basis_transforms(kx[i] * scale, basis);
      const Complex shift = turn(-kx[i] * origin.x);
      for (std::size_t j = 0; j < ny_; ++j) {
        const double* row = &differences_[j * nx_];
        double real = 0.0;
        double imaginary = 0.0;
        for (std::size_t l = 0; l < nx_; ++l) {
          real += row[l] * basis[l].real();
          imaginary += row[l] * basis[l].imag();
        }
        along_x[j * kx.size() + i] = Complex(real, imaginary) * shift;
      }
    }
    std::ranges::fill(values, Complex{});
    basis.resize(ny_);
    for (std::size_t q = 0; q < ky.size(); ++q) {
      basis_transforms(ky[q] * scale, basis);
      const Complex shift = turn(-ky[q] * origin.y);
      Complex* out = &values[q * kx.size()];
      for (std::size_t j = 0; j < ny_; ++j) {
        const Complex weight = basis[j] * shift;
        const double a = weight.real();
        const double b = weight.imag();
        const Complex* from = &along_x[j * kx.size()];
        for (std::size_t i = 0; i < kx.size(); ++i) {
          const double re = from[i].real();
          const double im = from[i].imag();
          out[i] += Complex(a * re - b * im, a * im + b * re);
        }
      }
    }
  }

  [[nodiscard]] double reach(double /*lost*/) const override {
    const PixelPosition lower = spline_.lower();
    const PixelPosition upper = spline_.upper();
    return std::max({-lower.x, -lower.y, upper.x, upper.y});
  }

  [[nodiscard]] double error_beyond(double band) const override { return band_error_->of(*this, band); }

  [[nodiscard]] std::string description() const override {
    return fmt::format("table of {} x {} samples, {} per px", spline_.nx(), spline_.ny(), spline_.samples_per_pixel());
  }

 private:
  detail::FluxSpline spline_;
  std::size_t nx_;  // differences along x
  std::size_t ny_;
  std::vector<double> differences_;
  std::optional<detail::BandError> band_error_;
};

}  // namespace

std::shared_ptr<const PsfSpectrum> make_table_spectrum(const PsfTable& table) {
  return std::make_shared<const TableSpectrum>(table);
}

}  // namespace astroid
