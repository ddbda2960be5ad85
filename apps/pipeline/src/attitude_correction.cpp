#include "astroid/pipeline/attitude_correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr StreamId kKnowledgeOfAttitude{200};
constexpr std::size_t kMostGuides = 200;
/// Standard deviations that the attitude may be off.
constexpr double kReach = 4.0;

/// Share of what saturates a pixel that a guide star may put into its brightest: jitter and noise need the rest.
constexpr double kUnsaturated = 0.8;

/// What saturates a pixel, e- above the bias and the mean background.
double saturation(const Mission& mission) {
  const double converted = (adc_top(mission.ccd.adc_bits) - mission.ccd.bias.value()) * mission.ccd.gain.value();
  return std::min(mission.ccd.full_well.value(), converted) - expected_pixel_noise(mission).background;
}

/// Light of a star in its brightest pixel, e-.
double brightest_pixel(const FieldStar& star, const PixelPsf& psf) {
  constexpr int kAround = 3;
  const auto first = [](double centre) { return static_cast<int>(std::lround(centre)) - kAround / 2; };
  std::array<double, std::size_t{kAround} * kAround> fractions{};
  psf.integrate(star.position, {first(star.position.x), first(star.position.y), kAround, kAround}, fractions);
  return star.electrons * *std::ranges::max_element(fractions);
}

/// The brightest targets that do not saturate.
std::vector<GuideStar> guide_stars(const Scene& scene, const GroundModel& model,
                                   std::span<const StarEstimator> estimators) {
  constexpr std::uint32_t kUnfit =
      measurement_flag::kEdge | measurement_flag::kBadPixel | measurement_flag::kOutside | measurement_flag::kNoFlux;
  const double limit = kUnsaturated * saturation(scene.mission());
  std::vector<std::size_t> stars;
  for (const StarEstimator& estimator : estimators)
    if ((estimator.flags & kUnfit) == 0 && brightest_pixel(model.stars[estimator.star], *model.psf) < limit)
      stars.push_back(estimator.star);
  std::ranges::stable_sort(stars, std::ranges::greater(), [&](std::size_t s) { return scene.stars()[s].electrons; });
  stars.resize(std::min(stars.size(), kMostGuides));
  std::vector<GuideStar> guides;
  guides.reserve(stars.size());
  for (const std::size_t star : stars) guides.push_back({star, scene.stars()[star].motion});
  return guides;
}

/// How far each axis may be off, arcsec.
Attitude reach_of(const Scene& scene) {
  const AttitudeVariance variance = scene.attitude().variance_of_mean(1);
  const Attitude& farthest = scene.attitude_trend().farthest();
  const auto reach = [](double v, double trend) { return kReach * std::sqrt(v) + std::abs(trend); };
  return {reach(variance.yaw, farthest.yaw), reach(variance.pitch, farthest.pitch),
          reach(variance.roll, farthest.roll)};
}

}  // namespace

AttitudeCorrection::AttitudeCorrection(const Scene& scene, const GroundModel& model,
                                       std::span<const StarEstimator> estimators, const Attitude& origin)
    : stream_(make_stream(scene.mission().simulation.seed, kKnowledgeOfAttitude, 0, 0)),
      known_rms_(scene.mission().photometry.knowledge.attitude.value()),
      origin_(origin),
      first_(scene.mission_number(0)) {
  for (const StarEstimator& estimator : estimators)
    responses_.push_back(attitude_response(estimator, scene.stars()[estimator.star].motion));
  if (scene.mission().photometry.jitter_correction == JitterCorrection::kKnown) {
    const double variance = known_rms_ * known_rms_;
    error_ = {.yaw_yaw = variance, .pitch_pitch = variance, .roll_roll = variance};
    return;
  }
  sensor_.emplace(*scene.layout(), model, scene.mission().photometry, guide_stars(scene, model, estimators),
                  reach_of(scene));
  if (sensor_->guides() == 0 && !estimators.empty())
    throw InputError(Problem{.parameter = "Photometry/JitterCorrection",
                             .value = "centroids",
                             .expected = "an unsaturated target whose window is on the detector, or another correction",
                             .message = "there is no star to measure the attitude by"});
  error_ = sensor_->covariance();
}

Attitude AttitudeCorrection::attitude(std::int64_t exposure, const Attitude& truth, const Frame& calibrated) const {
  if (sensor_) return sensor_->measure(calibrated).mean;
  const auto error = [&](std::uint32_t axis) {
    if (known_rms_ == 0.0) return 0.0;
    return known_rms_ * normal_at_step(stream_, {.step = static_cast<std::uint64_t>(first_ + exposure), .axis = axis});
  };
  return {truth.yaw - origin_.yaw + error(0), truth.pitch - origin_.pitch + error(1),
          truth.roll - origin_.roll + error(2)};
}

std::string AttitudeCorrection::description() const {
  if (!sensor_) return fmt::format("with the attitude that the spacecraft tells, {:.3g} arcsec rms off", known_rms_);
  return fmt::format(
      "with the attitude measured in each image by {} stars, {:.3g}, {:.3g} and {:.3g} arcsec rms off in yaw, pitch "
      "and "
      "roll",
      sensor_->guides(), std::sqrt(error_.yaw_yaw), std::sqrt(error_.pitch_pitch), std::sqrt(error_.roll_roll));
}

const AttitudeCorrection& correction_at(std::span<const CorrectionStretch> stretches, std::int64_t exposure) {
  const auto next = std::ranges::upper_bound(stretches, exposure, {}, &CorrectionStretch::first);
  return *std::prev(next)->correction;
}

}  // namespace astroid
