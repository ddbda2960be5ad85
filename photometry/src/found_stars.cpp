#include "astroid/photometry/found_stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/estimator.hpp"
#include "field/neighbours.hpp"

namespace astroid {

namespace {

constexpr double kRadius = 1.2;         // FWHM: where the noise of sky and star together is least
constexpr double kCrowdedRadius = 0.8;  // FWHM: less of the neighbours
constexpr double kLeastRadius = 1.5;    // px
constexpr double kReference = 4.0;      // FWHM, that all light of a star is taken to be within
constexpr double kPerPixel = 4.0;       // steps of a table over distances

// Light of a Gaussian star inside a circle of `radius` whose centre is so far away, in steps of 1/kPerPixel px.
std::vector<double> shares_by_distance(double fwhm, double radius) {
  const double sigma = std::hypot(fwhm / kFwhmPerSigma, std::sqrt(1.0 / 12.0));
  constexpr double kFarthest = 4.0;  // sigma beyond the circle
  const auto size = static_cast<std::size_t>(std::ceil((radius + kFarthest * sigma) * kPerPixel)) + 2;
  std::vector<double> shares(size);
  constexpr int kStrips = 64;
  const double scale = 1.0 / (sigma * std::sqrt(2.0));
  for (std::size_t i = 0; i < size; ++i) {
    const double distance = static_cast<double>(i) / kPerPixel;
    // Strips of the circle across the line between the two: an error function along each, Gaussian across.
    double sum = 0.0;
    for (int k = 0; k < kStrips; ++k) {
      const double u = radius * (2.0 * (k + 0.5) / kStrips - 1.0);
      const double half = std::sqrt(radius * radius - u * u);
      const double across = (u - distance) * scale;
      sum += det::exp(-across * across) * det::erf(half * scale);
    }
    shares[i] = sum * 2.0 * radius / kStrips * scale / std::sqrt(kPi);
  }
  return shares;
}

// Share of a Gaussian star's light in the pixel of its centre.
double central_share(double fwhm, double x, double y) {
  const double scale = kFwhmPerSigma / (fwhm * std::sqrt(2.0));
  const auto along = [scale](double u) {
    const double offset = u - std::floor(u + 0.5);
    return 0.5 * (det::erf((0.5 - offset) * scale) + det::erf((0.5 + offset) * scale));
  };
  return along(x) * along(y);
}

void add_crowding(const std::vector<DetectedStar>& stars, double fwhm, double radius, double correction,
                  std::span<SourceMeasurement> sources) {
  const std::vector<double> shares = shares_by_distance(fwhm, radius);
  const double reach = static_cast<double>(shares.size() - 2) / kPerPixel;
  std::vector<detail::ModelStar> places;
  places.reserve(stars.size());
  for (const DetectedStar& star : stars) places.push_back({.x = star.x, .y = star.y, .flux = star.light});
  const detail::Neighbours neighbours(places, reach);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    SourceMeasurement& source = sources[i];
    if (!std::isfinite(source.flux)) continue;
    neighbours.find(source.x, source.y, reach, near);
    double light = 0.0;
    for (const std::uint32_t j : near) {
      if (j == i) continue;
      const double t = std::hypot(places[j].x - source.x, places[j].y - source.y) * kPerPixel;
      const auto step = static_cast<std::size_t>(t);
      if (step + 1 >= shares.size()) continue;
      const double f = t - static_cast<double>(step);
      light += places[j].flux * ((1.0 - f) * shares[step] + f * shares[step + 1]);
    }
    const double all = source.flux / correction;
    const double own = std::max(all - light, 0.01 * all);
    source.crowding = own > 0.0 ? 2.5 * det::log10(std::max(1.0, all / own)) : SourceMeasurement::kUnknown;
  }
}

void add_sharpness(const Frame& frame, double fwhm, std::span<SourceMeasurement> sources) {
  const auto pixels = frame.pixels.view(0);
  const double gain = frame.header.gain.value();
  const double bias = frame.header.bias.value();
  for (SourceMeasurement& source : sources) {
    if (!(source.flux > 0.0) || !std::isfinite(source.background)) continue;
    const int x = static_cast<int>(std::floor(source.x + 0.5));
    const int y = static_cast<int>(std::floor(source.y + 0.5));
    if (!pixels.area().contains(x, y)) continue;
    const double light = gain * (static_cast<double>(pixels.at(x, y)) - bias) - source.background;
    // Without a correction the flux lacks what lies outside of the circle, a few per cent.
    source.sharpness = light / (source.flux * central_share(fwhm, source.x, source.y)) - 1.0;
  }
}

}  // namespace

double share_with_neighbours(std::span<const PixelPosition> places, double distance) {
  std::vector<detail::ModelStar> stars;
  stars.reserve(places.size());
  for (const PixelPosition& place : places)
    if (std::isfinite(place.x) && std::isfinite(place.y)) stars.push_back({.x = place.x, .y = place.y});
  if (stars.empty() || !(distance > 0.0)) return 0.0;
  const detail::Neighbours neighbours(stars, distance);
  std::vector<std::uint32_t> near;
  std::size_t with = 0;
  for (const detail::ModelStar& star : stars) {
    neighbours.find(star.x, star.y, distance, near);
    with += near.size() > 1 ? 1 : 0;
  }
  return static_cast<double>(with) / static_cast<double>(stars.size());
}

FoundStars measure_found_stars(const Frame& frame, const SkyProjection* sky, const FoundStarsSettings& settings) {
  FoundStars result;
  ImagePhotometrySettings measure = settings.measure;
  measure.method = PhotometryMethod::kAperture;
  if (!measure.map) measure.map = std::make_shared<const BackgroundMap>(frame, 0, measure.mesh);
  result.detection = detect_stars(frame, *measure.map, settings.detection);
  const double fwhm = result.detection.fwhm;
  std::vector<SourceRequest> requests;
  std::vector<PixelPosition> places;
  std::vector<double> light;
  requests.reserve(result.detection.stars.size());
  for (const DetectedStar& star : result.detection.stars) {
    places.push_back({star.x, star.y});
    light.push_back(star.light);
    requests.push_back({fmt::format("{}", requests.size()), places.back(), std::nullopt});
  }
  result.neighbours = share_with_neighbours(places, kCrowdedDistance * fwhm);
  const double radius = result.neighbours > kCrowdedShare ? kCrowdedRadius : kRadius;
  result.radius = settings.radius ? settings.radius->value() : std::max(kLeastRadius, radius * fwhm);
  measure.aperture_radius = Pixels(result.radius);
  result.sources = measure_image(frame, sky, requests, measure);
  const bool given = measure.psf != nullptr && measure.whole_star;  // the PSF says what is outside
  if (settings.correct && !given && (settings.correct_to || !settings.radius)) {
    const double reference = settings.correct_to ? settings.correct_to->value() : kReference * fwhm;
    GrowthSettings growth;
    growth.radius = result.radius;
    growth.reference = settings.correct_to ? reference : std::max(reference, result.radius + 1.0);
    const GrowthCurve curve = measure_growth(frame, *measure.map, places, light, growth);
    result.correction_stars = curve.stars;
    if (!curve.light.empty() && curve.light.front() > 0.0) {
      result.reference = growth.reference;
      result.correction = 1.0 / curve.light.front();
      result.correction_error = curve.error.front() * result.correction * result.correction;
      for (SourceMeasurement& source : result.sources) {
        source.flux *= result.correction;
        source.flux_err *= result.correction;
        source.mag -= 2.5 * det::log10(result.correction);
      }
    }
  }
  for (std::size_t i = 0; i < result.sources.size(); ++i)
    result.sources[i].position_err = result.detection.stars[i].position_error;
  add_crowding(result.detection.stars, fwhm, result.radius, result.correction, result.sources);
  add_sharpness(frame, fwhm, result.sources);
  return result;
}

}  // namespace astroid
