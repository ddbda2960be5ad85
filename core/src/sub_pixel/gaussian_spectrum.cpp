#include <fmt/format.h>
#include <gsl/gsl_sf_expint.h>

#include <cmath>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/core/psf_spectrum.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kTwoPiSquared = 19.7392088021787172376689819991127;

class GaussianSpectrum final : public PsfSpectrum {
 public:
  explicit GaussianSpectrum(double sigma) : sigma_(sigma), psf_(make_gaussian_psf(sigma)) {}

  void sample(std::span<const double> kx, std::span<const double> ky,
              std::span<std::complex<double>> values) const override {
    ASTROID_CHECK_EQ(values.size(), kx.size() * ky.size());
    std::vector<double> along_x(kx.size());
    for (std::size_t i = 0; i < kx.size(); ++i) along_x[i] = profile(kx[i]);
    auto value = values.begin();
    for (const double k : ky) {
      const double along_y = profile(k);
      for (const double x : along_x) *value++ = along_y * x;
    }
  }

  [[nodiscard]] double reach(double lost) const override { return psf_->stamp_half_width(lost); }

  // A square of width w has the transform sin(pi k w)/(pi k) along each axis, at most 1/(pi k). Beyond the band on both
  // sides of one axis this leaves 2/pi of the integral of H(k)/k, which is E1(2 pi² sigma² band²)/2; the other axis
  // contributes the flux itself, at most 1.
  [[nodiscard]] double error_beyond(double band) const override {
    constexpr double kFarthest = 700.0;  // where E1 underflows
    const double argument = kTwoPiSquared * sigma_ * sigma_ * band * band;
    if (argument > kFarthest) return 0.0;
    const double axis = gsl_sf_expint_E1(argument) / kPi;
    return 2.0 * axis + axis * axis;
  }

  [[nodiscard]] std::string description() const override { return fmt::format("Gaussian of sigma {} px", sigma_); }

 private:
  [[nodiscard]] double profile(double k) const { return det::exp(-kTwoPiSquared * sigma_ * sigma_ * k * k); }

  double sigma_;
  std::shared_ptr<const PixelPsf> psf_;
};

}  // namespace

std::shared_ptr<const PsfSpectrum> make_gaussian_spectrum(double sigma) {
  if (!(sigma > 0.0) || std::isinf(sigma)) {
    throw InputError(Problem{.parameter = "PSF/Sigma",
                             .value = fmt::format("{}", sigma),
                             .expected = "a finite number of pixels > 0",
                             .message = "a PSF of this width has no band limit"});
  }
  return std::make_shared<const GaussianSpectrum>(sigma);
}

}  // namespace astroid
