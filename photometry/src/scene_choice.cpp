#include "astroid/photometry/scene_choice.hpp"

#include <fmt/format.h>

#include <cmath>

#include "astroid/photometry/found_stars.hpp"

namespace astroid {

namespace {

constexpr double kUndersampled = 1.6;  // px of FWHM: a Gaussian is sampled at less than 1.5 σ

}  // namespace

MethodChoice choose_method(const ImageScene& scene) {
  const bool crowded = scene.neighbours > kCrowdedShare;
  const bool undersampled = scene.fwhm < kUndersampled;  // false for NaN
  const std::string crowd =
      fmt::format("{:.0f} % of {} stars have another within three FWHM", 100.0 * scene.neighbours, scene.stars);
  if (!scene.psf_given) {
    if (crowded)
      return {
          PhotometryMethod::kAperture,
          fmt::format("no PSF was given, so circles, though {}: with --psf their light could be told apart", crowd)};
    return {PhotometryMethod::kAperture, fmt::format("no PSF was given, and {}: circles lose little", crowd)};
  }
  if (scene.catalogue && !crowded && undersampled)
    return {PhotometryMethod::kWeighted,
            fmt::format("the PSF is undersampled (FWHM {:.2f} px), where its errors within a pixel matter, and only {}",
                        scene.fwhm, crowd)};
  if (crowded)
    return {PhotometryMethod::kPsf, fmt::format("the PSF is given, and {}: they are fitted together", crowd)};
  return {PhotometryMethod::kPsf, fmt::format("the PSF is given, and fitting it has the least noise; {}", crowd)};
}

std::optional<MeasuredGain> measure_gain(const BackgroundMap& background) {
  const auto level = background.cell_levels();
  const auto rms = background.cell_rms();
  constexpr std::size_t kFewest = 9;
  constexpr double kSignificant = 5.0;
  std::size_t n = 0;
  double mean_level = 0.0;
  double mean_variance = 0.0;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (!std::isfinite(level[i]) || !(rms[i] > 0.0)) continue;
    ++n;
    mean_level += level[i];
    mean_variance += rms[i] * rms[i];
  }
  if (n < kFewest) return std::nullopt;
  mean_level /= static_cast<double>(n);
  mean_variance /= static_cast<double>(n);
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (!std::isfinite(level[i]) || !(rms[i] > 0.0)) continue;
    const double x = level[i] - mean_level;
    const double y = rms[i] * rms[i] - mean_variance;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  if (!(xx > 0.0)) return std::nullopt;
  const double slope = xy / xx;
  // Cells were smoothed over three by three neighbours, so a ninth of them are independent.
  constexpr double kIndependent = 1.0 / 9.0;
  const double free = std::max(1.0, kIndependent * static_cast<double>(n) - 2.0);
  const double residual = std::max(0.0, yy - slope * xy) * kIndependent;
  const double error = std::sqrt(residual / free / (xx * kIndependent));
  if (!(slope > kSignificant * error)) return std::nullopt;
  return MeasuredGain{1.0 / slope, error / (slope * slope)};
}

}  // namespace astroid
