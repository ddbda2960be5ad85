#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "bessel.hpp"
#include "circular_profile.hpp"
#include "gauss_legendre.hpp"
#include "radial_table.hpp"

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

// How light ends: F120.
constexpr double kWidestFade = 0.5;          // px, rms of the edge
constexpr double kFadesInReach = 24.0;       // that many rms in the reach at least
constexpr double kFadeLength = 6.0;          // rms, from its middle to the reach, where 1e-9 is left
constexpr double kFarthestDiffusion = 12.5;  // sigmas: the corners of diffused()'s square

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

namespace {

/// The profile convolved with a Gaussian of rms `sigma` px at distance r. The trapezium rule converges beyond all
/// orders for what is smooth: with 1.43 nodes per sigma the Gaussian leaves 1e-17, with 5 per scale the profile 1e-14.
double diffused(const CircularProfile& profile, double sigma, double r) {
  constexpr double kPerSigma = 1.43;
  constexpr double kPerScale = 5.0;
  constexpr double kReach = 8.5;  // sigmas, beyond which a Gaussian has 1e-16
  const double step = 1.0 / (kPerSigma / sigma + kPerScale / profile.scale);
  const int last = static_cast<int>(std::ceil(kReach * sigma / step));
  std::vector<double> gaussian;
  for (int i = 0; i <= last; ++i) {
    const double u = i * step / sigma;
    gaussian.push_back(step / sigma * det::exp(-0.5 * u * u) / det::sqrt(2.0 * kPi));
  }
  double sum = 0.0;
  for (int j = 0; j <= last; ++j) {
    const double y2 = j * step * (j * step);
    double line = 0.0;
    for (int i = -last; i <= last; ++i) {
      const double x = r + i * step;
      line += gaussian[static_cast<std::size_t>(std::abs(i))] * profile.density(x * x + y2);
    }
    sum += (j == 0 ? 1.0 : 2.0) * gaussian[static_cast<std::size_t>(j)] * line;
  }
  return sum;
}

}  // namespace

CircularProfile as_imaged(const CircularProfile& profile, const PsfWings& wings) {
  constexpr double kPanelsPerScale = 4.0;
  const auto end = static_cast<double>(wings.reach);
  const double softness = std::min(kWidestFade, end / kFadesInReach);
  const double middle = end - kFadeLength * softness;
  const double sigma = wings.diffusion;
  // The profile itself is dear to evaluate, and the Gaussian wants it many times, beyond the reach too.
  std::optional<RadialTable> sharp;
  if (sigma > 0.0)
    sharp.emplace([&](double r) { return profile.density(r * r); }, end + kFarthestDiffusion * sigma,
                  profile.scale / kPanelsPerScale);
  const CircularProfile quick{
      .density = [&sharp](double r2) { return sharp->at(r2); }, .scale = profile.scale, .name = {}};
  const double scale = std::min(det::hypot(profile.scale, sigma), 2.0 * softness);
  auto table = std::make_shared<const RadialTable>(
      [&](double r) {
        const double fade = 0.5 * det::erfc((r - middle) / (det::sqrt(2.0) * softness));
        return fade * (sigma > 0.0 ? diffused(quick, sigma, r) : profile.density(r * r));
      },
      end, scale / kPanelsPerScale);
  return {.density = [table = std::move(table)](double r2) { return table->at(r2); },
          .scale = scale,
          .name = sigma > 0.0 ? fmt::format("{}, diffused by {} px", profile.name, sigma) : profile.name};
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
