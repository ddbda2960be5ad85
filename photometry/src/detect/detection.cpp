#include "astroid/photometry/detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "detect/peaks.hpp"
#include "detect/smooth_image.hpp"
#include "field/matched_filter.hpp"

namespace astroid {

namespace {

constexpr double kFwhmPerSigma = 2.3548200450309493;
constexpr double kDefaultFwhm = 2.0;           // px, where no star tells
constexpr double kPixelVariance = 1.0 / 12.0;  // px², of a pixel's own width

void check_settings(const DetectionSettings& settings) {
  std::vector<Problem> problems;
  const auto check = [&problems](const char* parameter, double value, bool good, const char* expected) {
    if (good && std::isfinite(value)) return;
    problems.push_back(Problem{.parameter = parameter,
                               .value = fmt::format("{}", value),
                               .expected = expected,
                               .message = "stars cannot be detected"});
  };
  check("threshold", settings.threshold, settings.threshold > 0.0, "more than 0");
  check("footprint", settings.footprint, settings.footprint > 0.0 && settings.footprint <= settings.threshold,
        "more than 0 and not above the threshold");
  check("prominence", settings.prominence, settings.prominence >= 0.0, "0 or more");
  check("contrast", settings.contrast, settings.contrast >= 0.0 && settings.contrast < 1.0, "0 to 1");
  if (!problems.empty()) throw InputError(std::move(problems));
}

// Where a parabola through the logarithms of three values has its top, within half a step: exact for a Gaussian.
double top_of(float left, float middle, float right) {
  if (!(left > 0.0F && right > 0.0F)) return 0.0;
  const double l = det::log(static_cast<double>(left));
  const double m = det::log(static_cast<double>(middle));
  const double r = det::log(static_cast<double>(right));
  const double curvature = l - 2.0 * m + r;
  return curvature < 0.0 ? std::clamp(0.5 * (l - r) / curvature, -0.5, 0.5) : 0.0;
}

// The PSF as one product of a column and a row.
detail::FilterKernel kernel_of(const PixelPsf& psf, const Rectangle& area) {
  constexpr int kHalf = 12;  // px; lines are cut where they hold nothing more
  const int x = area.x0 + area.nx / 2;
  const int y = area.y0 + area.ny / 2;
  const Rectangle box{x - kHalf, y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1};
  std::vector<double> stamp(box.size());
  psf.integrate({static_cast<double>(x), static_cast<double>(y)}, box, stamp);
  constexpr double kOneTerm = 0.999;  // of the root of the sum of squares: stop after the first
  const detail::SeparableKernel separable(stamp, kOneTerm);
  detail::FilterKernel kernel{separable.terms().front().column, separable.terms().front().row};
  for (std::vector<float>* line : {&kernel.column, &kernel.row}) {
    constexpr float kLeast = 0.02F;  // of the middle
    const float middle = (*line)[kHalf];
    std::size_t cut = 0;
    while (cut + 1 < kHalf && std::abs((*line)[cut]) < kLeast * std::abs(middle) &&
           std::abs((*line)[line->size() - 1 - cut]) < kLeast * std::abs(middle))
      ++cut;
    line->erase(line->end() - static_cast<std::ptrdiff_t>(cut), line->end());
    line->erase(line->begin(), line->begin() + static_cast<std::ptrdiff_t>(cut));
    double sum = 0.0;
    for (const float value : *line) sum += static_cast<double>(value);
    for (float& value : *line) value = static_cast<float>(static_cast<double>(value) / sum);
  }
  return kernel;
}

double fwhm_of(const detail::FilterKernel& kernel) {
  // A Gaussian has as many noise pixels, with the width of a pixel taken off.
  const double variance = 1.0 / (4.0 * kPi * kernel.norm() * kernel.norm());
  return kFwhmPerSigma * std::sqrt(std::max(0.01, variance - kPixelVariance));
}

}  // namespace

double measure_fwhm(const Frame& frame, const BackgroundMap& background) {
  constexpr double kLeastHeight = 20.0;  // of the scatter of a pixel
  constexpr std::size_t kFewest = 5;
  constexpr std::size_t kMost = 100;  // the brightest
  const auto pixels = frame.pixels.view(0);
  const auto flags = frame.flags.view(0);
  const Rectangle& area = pixels.area();
  const double level = background.median_level();
  if (!std::isfinite(level)) return std::numeric_limits<double>::quiet_NaN();
  const auto least = static_cast<float>(level + kLeastHeight * background.median_rms());
  struct Bright {
    float height;
    int x, y;
  };
  std::vector<Bright> bright;
  for (int y = area.y0 + 1; y + 1 < area.y1(); ++y) {
    const auto below = pixels.row(y - 1);
    const auto row = pixels.row(y);
    const auto above = pixels.row(y + 1);
    for (std::size_t i = 1; i + 1 < row.size(); ++i) {
      const float v = row[i];
      if (!(v > least)) continue;
      const bool top = v > row[i - 1] && v >= row[i + 1] && v > below[i - 1] && v > below[i] && v > below[i + 1] &&
                       v >= above[i - 1] && v >= above[i] && v >= above[i + 1];
      if (top) bright.push_back({v, area.x0 + static_cast<int>(i), y});
    }
  }
  std::sort(bright.begin(), bright.end(), [](const Bright& a, const Bright& b) {
    if (a.height != b.height) return a.height > b.height;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  // Three pixels `step` apart: the nearest tell a narrow star; of a wide one their difference is lost in the noise.
  const auto saturation = static_cast<float>(frame.header.saturation.value());
  const auto median_variance = [&](int step) {
    std::vector<double> variances;
    for (const Bright& b : bright) {
      if (variances.size() >= kMost) break;
      const bool inside =
          b.x - step >= area.x0 && b.x + step < area.x1() && b.y - step >= area.y0 && b.y + step < area.y1();
      bool clean = inside && b.height < saturation;
      for (int y = b.y - step; y <= b.y + step && clean; ++y)
        for (int x = b.x - step; x <= b.x + step && clean; ++x)
          clean = (flags.at(x, y) & ~pixel_flag::kTruth) == 0 && static_cast<double>(pixels.at(x, y)) > level &&
                  pixels.at(x, y) <= b.height;
      if (!clean) continue;
      const auto log_at = [&](int x, int y) { return det::log(static_cast<double>(pixels.at(x, y)) - level); };
      const double middle = log_at(b.x, b.y);
      const double along_x = 2.0 * middle - log_at(b.x - step, b.y) - log_at(b.x + step, b.y);
      const double along_y = 2.0 * middle - log_at(b.x, b.y - step) - log_at(b.x, b.y + step);
      if (along_x > 0.0 && along_y > 0.0) variances.push_back(step * step / std::sqrt(along_x * along_y));
    }
    if (variances.size() < kFewest) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    return *middle;
  };
  double variance = median_variance(1);
  constexpr int kWidestStep = 8;  // px
  // Noise on the top of a wide star makes it look narrow, so the step grows until it is about one sigma.
  for (int step = 1; std::isfinite(variance) && step < kWidestStep;) {
    const int next = std::min(kWidestStep, static_cast<int>(std::lround(std::sqrt(variance))));
    if (next <= step) break;
    step = next;
    const double wider = median_variance(step);
    if (!std::isfinite(wider)) break;
    variance = wider;
  }
  if (!std::isfinite(variance)) return variance;
  constexpr double kLeastVariance = 0.05;  // px²: FWHM 0.5 px, all light in one pixel
  return kFwhmPerSigma * std::sqrt(std::max(kLeastVariance, variance - kPixelVariance));
}

Detection detect_stars(const Frame& frame, const BackgroundMap& background, const DetectionSettings& settings) {
  check_settings(settings);
  Detection result;
  detail::FilterKernel kernel;
  if (settings.psf != nullptr) {
    kernel = kernel_of(*settings.psf, background.area());
    result.fwhm = fwhm_of(kernel);
  } else {
    const double fwhm = measure_fwhm(frame, background);
    result.fwhm_measured = std::isfinite(fwhm);
    constexpr double kWidest = 20.0;  // px
    result.fwhm = result.fwhm_measured ? std::min(fwhm, kWidest) : kDefaultFwhm;
    kernel = detail::gaussian_kernel(result.fwhm);
  }
  const double norm = kernel.norm();
  result.noise_pixels = 1.0 / (norm * norm);
  // Without scatter nothing is significant, and without a sky nothing can be.
  if (!(background.median_rms() > 0.0)) return result;
  const double noise = frame.header.gain.value() * background.median_rms();  // e-
  const detail::SmoothImage image(frame, background, kernel);
  const detail::PeakSettings peak_settings{settings.threshold, settings.footprint, settings.prominence,
                                           settings.contrast, norm / noise};
  const double sigma = result.fwhm / kFwhmPerSigma;
  const double variance = sigma * sigma + kPixelVariance;
  for (const detail::FilteredPeak& peak : detail::find_peaks(image, peak_settings)) {
    DetectedStar star;
    star.x =
        background.area().x0 + peak.x + top_of(image.at(peak.x - 1, peak.y), peak.height, image.at(peak.x + 1, peak.y));
    star.y =
        background.area().y0 + peak.y + top_of(image.at(peak.x, peak.y - 1), peak.height, image.at(peak.x, peak.y + 1));
    star.significance = static_cast<double>(peak.height);
    star.light = star.significance * noise / norm;
    // Of the top of a Gaussian star filtered by its own shape: noise of the sky, and of the star's own photons.
    constexpr double kPhotons = 16.0 / 9.0;
    star.position_error =
        std::sqrt(variance * (2.0 / (star.significance * star.significance) + kPhotons / std::max(1.0, star.light)));
    star.area = peak.area;
    result.stars.push_back(star);
  }
  return result;
}

}  // namespace astroid
