#include "astroid/pipeline/attitude_correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

namespace {

constexpr StreamId kKnowledgeOfAttitude{200};
constexpr std::size_t kMostGuides = 200;
/// Standard deviations that the attitude may be off.
constexpr double kReach = 4.0;

/// The brightest targets that no exposure saturates.
std::vector<GuideStar> guide_stars(const Scene& scene, std::span<const StarEstimator> estimators) {
  constexpr std::uint32_t kUnfit = measurement_flag::kSaturated | measurement_flag::kEdge |
                                   measurement_flag::kBadPixel | measurement_flag::kOutside | measurement_flag::kNoFlux;
  std::vector<std::size_t> stars;
  for (const StarEstimator& estimator : estimators)
    if ((estimator.flags & kUnfit) == 0) stars.push_back(estimator.star);
  std::ranges::stable_sort(stars, std::ranges::greater(), [&](std::size_t s) { return scene.stars()[s].electrons; });
  stars.resize(std::min(stars.size(), kMostGuides));
  std::vector<GuideStar> guides;
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
      origin_(origin) {
  for (const StarEstimator& estimator : estimators)
    responses_.push_back(attitude_response(estimator, scene.stars()[estimator.star].motion));
  if (scene.mission().photometry.jitter_correction == JitterCorrection::kKnown) {
    const double variance = known_rms_ * known_rms_;
    error_ = {.yaw_yaw = variance, .pitch_pitch = variance, .roll_roll = variance};
    return;
  }
  sensor_.emplace(*scene.layout(), model, scene.mission().photometry, guide_stars(scene, estimators), reach_of(scene));
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
    return known_rms_ * normal_at_step(stream_, {.step = static_cast<std::uint64_t>(exposure), .axis = axis});
  };
  return {truth.yaw - origin_.yaw + error(0), truth.pitch - origin_.pitch + error(1),
          truth.roll - origin_.roll + error(2)};
}

std::string AttitudeCorrection::description() const {
  if (!sensor_) return fmt::format("with the attitude that the spacecraft tells, {:.3g} arcsec rms off", known_rms_);
  return fmt::format(
      "with the attitude measured in each image by {} stars, {:.3g}, {:.3g} and {:.3g} arcsec rms off in yaw, pitch and "
      "roll",
      sensor_->guides(), std::sqrt(error_.yaw_yaw), std::sqrt(error_.pitch_pitch), std::sqrt(error_.roll_roll));
}

const AttitudeCorrection& correction_at(std::span<const CorrectionStretch> stretches, std::int64_t exposure) {
  const auto next = std::ranges::upper_bound(stretches, exposure, {}, &CorrectionStretch::first);
  return *std::prev(next)->correction;
}

}  // namespace astroid
