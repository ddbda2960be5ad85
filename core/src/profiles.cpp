#include <fmt/format.h>
#include <gsl/gsl_sf_bessel.h>
#include <gsl/gsl_spline.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "bessel.hpp"
#include "circular_profile.hpp"
#include "gauss_legendre.hpp"

namespace astroid::detail {

namespace {

void require(bool holds, const char* parameter, double value, const char* expected, std::vector<Problem>& problems) {
  if (holds && std::isfinite(value)) return;
  problems.push_back({.parameter = parameter,
                      .value = fmt::format("{}", value),
                      .expected = expected,
                      .message = "the PSF cannot be made"});
}

void require_wings(const PsfWings& wings, std::vector<Problem>& problems) {
  require(wings.reach >= 2 && wings.reach <= PsfWings::kLongestReach, "PSF/Reach", wings.reach, "2 .. 90 px", problems);
  require(wings.diffusion >= 0.0 && wings.diffusion <= 3.0, "PSF/ChargeDiffusion", wings.diffusion, "0 .. 3 px",
          problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

/// A natural cubic spline, to be shared.
class Spline {
 public:
  Spline(const std::vector<double>& x, const std::vector<double>& y)
      : spline_(gsl_spline_alloc(gsl_interp_cspline, x.size()), &gsl_spline_free) {
    gsl_spline_init(spline_.get(), x.data(), y.data(), x.size());
  }
  [[nodiscard]] double at(double x) const { return gsl_spline_eval(spline_.get(), x, nullptr); }

 private:
  std::unique_ptr<gsl_spline, decltype(&gsl_spline_free)> spline_;
};

/// Widest panel of a rule for a profile: its poles are at least half of it away.
double panel_of(const CircularProfile& profile) {
  return 2.0 * profile.scale;
}

}  // namespace

CircularProfile moffat_profile(double fwhm, double beta, const PsfWings& wings) {
  std::vector<Problem> problems;
  require(fwhm >= 0.2 && fwhm <= 20.0, "PSF/FWHM", fwhm, "0.2 .. 20 px", problems);
  require(beta > 1.0 && beta <= 100.0, "PSF/Beta", beta, "more than 1, at most 100", problems);
  require_wings(wings, problems);
  const double alpha = 0.5 * fwhm / det::sqrt(det::expm1(det::log(2.0) / beta));
  const double peak = (beta - 1.0) / (kPi * alpha * alpha);
  const double per_alpha2 = 1.0 / (alpha * alpha);
  return {.density = [=](double r2) { return peak * det::exp(-beta * det::log1p(r2 * per_alpha2)); },
          .scale = 0.5 * fwhm,
          .name = fmt::format("Moffat of FWHM {} px, beta {}", fwhm, beta)};
}

CircularProfile airy_profile(double lambda_over_d, double obscuration, const PsfWings& wings) {
  std::vector<Problem> problems;
  require(lambda_over_d >= 0.3 && lambda_over_d <= 20.0, "PSF/LambdaOverD", lambda_over_d, "0.3 .. 20 px", problems);
  require(obscuration >= 0.0 && obscuration < 1.0, "PSF/Obscuration", obscuration, "0 to less than 1", problems);
  require_wings(wings, problems);
  const double e2 = obscuration * obscuration;
  // The peak is the area of the aperture in units of (lambda / px)²; the amplitude that of a disc less its centre.
  const double peak = 0.25 * kPi * (1.0 - e2) / (lambda_over_d * lambda_over_d);
  const double per_px = kPi / lambda_over_d;
  return {.density =
              [=](double r2) {
                const double v = per_px * det::sqrt(r2);
                const double full = jinc(v);
                const double amplitude = e2 > 0.0 ? (full - e2 * jinc(obscuration * v)) / (1.0 - e2) : full;
                return peak * amplitude * amplitude;
              },
          .scale = 0.5 * lambda_over_d,
          .name = fmt::format("Airy pattern of lambda/D {} px, obscuration {}", lambda_over_d, obscuration)};
}

CircularProfile diffused(const CircularProfile& profile, double sigma, double reach) {
  constexpr double kReach = 8.5;       // sigmas, beyond which a Gaussian has 1e-16
  constexpr double kPerScale = 128.0;  // nodes of the spline; their distance to the fourth power is what it errs
  constexpr int kMirrored = 32;        // nodes beyond the centre, by which the natural end of the spline is forgotten
  const double scale = std::sqrt(profile.scale * profile.scale + sigma * sigma);
  const double step = std::max(profile.scale, sigma) / kPerScale;
  const int count = static_cast<int>(std::ceil(reach * std::sqrt(2.0) / step)) + kMirrored;
  const double per_variance = 1.0 / (sigma * sigma);
  const auto value = [&](double r) {
    double sum = 0.0;
    for (const QuadratureNode& node :
         gauss_legendre(std::max(0.0, r - kReach * sigma), r + kReach * sigma, std::min(sigma, panel_of(profile)))) {
      const double away = node.place - r;
      sum += node.weight * profile.density(node.place * node.place) * node.place * per_variance *
             det::exp(-0.5 * away * away * per_variance) * gsl_sf_bessel_I0_scaled(node.place * r * per_variance);
    }
    return sum;
  };
  std::vector<double> r;
  std::vector<double> density;
  for (int i = -kMirrored; i <= count; ++i) {
    r.push_back(i * step);
    density.push_back(i < 0 ? 0.0 : value(i * step));
  }
  for (int i = 1; i <= kMirrored; ++i)
    density[static_cast<std::size_t>(kMirrored - i)] = density[static_cast<std::size_t>(kMirrored + i)];
  return {
      .density = [spline = std::make_shared<const Spline>(r, density)](double r2) { return spline->at(det::sqrt(r2)); },
      .scale = scale,
      .name = fmt::format("{}, diffused by {} px", profile.name, sigma)};
}

double profile_flux(const CircularProfile& profile, PixelPosition lower, PixelPosition upper) {
  const std::vector<QuadratureNode> along_x = gauss_legendre(lower.x, upper.x, panel_of(profile));
  const std::vector<QuadratureNode> along_y = gauss_legendre(lower.y, upper.y, panel_of(profile));
  double sum = 0.0;
  for (const QuadratureNode& y : along_y) {
    double line = 0.0;
    for (const QuadratureNode& x : along_x) line += x.weight * profile.density(x.place * x.place + y.place * y.place);
    sum += y.weight * line;
  }
  return sum;
}

}  // namespace astroid::detail
