#include "astroid/photometry/detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "detect/peaks.hpp"
#include "detect/smooth_image.hpp"

namespace astroid {

namespace {

constexpr double kDefaultFwhm = 2.0;  // px, where no star tells
// The filter is narrower than a star: 6 % less significance of stars alone, and pairs are told apart that the star's
// own shape would join, half of those it misses in a crowd.
constexpr double kFilterWidth = 0.7;
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

// Of a Gaussian with as many noise pixels as the PSF has, without the width of a pixel.
double fwhm_of(const PixelPsf& psf, const Rectangle& area) {
  constexpr int kHalf = 20;  // px
  const int x = area.x0 + area.nx / 2;
  const int y = area.y0 + area.ny / 2;
  const Rectangle box{x - kHalf, y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1};
  std::vector<double> stamp(box.size());
  psf.integrate({static_cast<double>(x), static_cast<double>(y)}, box, stamp);
  double squares = 0.0;
  for (const double share : stamp) squares += share * share;
  constexpr double kLeastVariance = 0.01;  // px²
  return kFwhmPerSigma * std::sqrt(std::max(kLeastVariance, 1.0 / (4.0 * kPi * squares) - kPixelVariance));
}

// Sum of the products of two kernels that are centred on each other.
double overlap_of(const detail::FilterKernel& a, const detail::FilterKernel& b) {
  const auto along = [](const std::vector<float>& u, const std::vector<float>& v) {
    const std::size_t size = std::min(u.size(), v.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i)
      sum += static_cast<double>(u[i + (u.size() - size) / 2]) * static_cast<double>(v[i + (v.size() - size) / 2]);
    return sum;
  };
  return along(a.column, b.column) * along(a.row, b.row);
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
  constexpr double kStepPerSigma = 1.2;
  // Noise on the top of a wide star makes it look narrow, so the step grows until it is about one sigma.
  for (int step = 1; std::isfinite(variance) && step < kWidestStep;) {
    const int next = std::min(kWidestStep, static_cast<int>(std::lround(kStepPerSigma * std::sqrt(variance))));
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
  if (settings.psf != nullptr) {
    result.fwhm = fwhm_of(*settings.psf, background.area());
  } else {
    const double fwhm = measure_fwhm(frame, background);
    result.fwhm_measured = std::isfinite(fwhm);
    constexpr double kWidest = 20.0;  // px
    result.fwhm = result.fwhm_measured ? std::min(fwhm, kWidest) : kDefaultFwhm;
  }
  const detail::FilterKernel star_shape = detail::gaussian_kernel(result.fwhm);
  const detail::FilterKernel kernel = detail::gaussian_kernel(kFilterWidth * result.fwhm);
  const double norm = kernel.norm();
  const double overlap = overlap_of(kernel, star_shape);
  // Without scatter nothing is significant, and without a sky nothing can be.
  if (!(background.median_rms() > 0.0)) return result;
  const double noise = frame.header.gain.value() * background.median_rms();  // e-
  const detail::SmoothImage image(frame, background, kernel);
  const detail::PeakSettings peak_settings{settings.threshold, settings.footprint, settings.prominence,
                                           settings.contrast, norm / noise};
  // Noise of the top of a Gaussian star of variance s² filtered by one of variance f², along an axis: from the sky
  // (s² + f²)² / (2 f² S²), S its significance; from its own N photons w² (s² + f²)⁴ / (f⁸ s² N), 1/w = 2/f² + 1/s².
  const double s2 = result.fwhm * result.fwhm / (kFwhmPerSigma * kFwhmPerSigma) + kPixelVariance;
  const double f2 = (s2 - kPixelVariance) * kFilterWidth * kFilterWidth + kPixelVariance;
  const double w = f2 * s2 / (2.0 * s2 + f2);
  const double both = s2 + f2;
  const double of_sky = both * both / (2.0 * f2);
  const double of_photons = w * w * both * both * both * both / (f2 * f2 * f2 * f2 * s2);
  for (const detail::FilteredPeak& peak : detail::find_peaks(image, peak_settings)) {
    DetectedStar star;
    star.x =
        background.area().x0 + peak.x + top_of(image.at(peak.x - 1, peak.y), peak.height, image.at(peak.x + 1, peak.y));
    star.y =
        background.area().y0 + peak.y + top_of(image.at(peak.x, peak.y - 1), peak.height, image.at(peak.x, peak.y + 1));
    star.significance = static_cast<double>(peak.height);
    star.light = star.significance * noise * norm / overlap;
    star.position_error =
        std::sqrt(of_sky / (star.significance * star.significance) + of_photons / std::max(1.0, star.light));
    star.area = peak.area;
    result.stars.push_back(star);
  }
  return result;
}

}  // namespace astroid
