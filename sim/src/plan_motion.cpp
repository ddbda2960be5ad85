#include "plan_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/math.hpp"
#include "plan_cost.hpp"

namespace astroid {

namespace {

constexpr double kReach = 4.5;       // rms of the jitter in one cell: others are seldom needed
constexpr double kUsualReach = 1.5;  // rms

/// How much farther motion seems to reach beside brighter stars, whose wings are steeper than a star's own core: for
/// the worst of all targets the polynomial is good to the accuracy within kUsualReach, for others to the border of a
/// cell.
double stretch(const SceneSummary& s) {
  return std::max(1.0, det::sqrt(s.neighbour_curvature) * kUsualReach / kReach);
}

/// Displacement of any star by one unit of each axis, px, stretched.
AttitudeReach per_arcsec(const Scene& scene) {
  AttitudeReach reach;
  const double by = stretch(scene.summary());
  for (const SceneStar& star : scene.stars()) {
    const AttitudeJacobian& j = star.motion;
    reach.yaw = std::max(reach.yaw, det::hypot(j.dx_dyaw, j.dy_dyaw));
    reach.pitch = std::max(reach.pitch, det::hypot(j.dx_dpitch, j.dy_dpitch));
    reach.roll = std::max(reach.roll, det::hypot(j.dx_droll, j.dy_droll));
  }
  reach.yaw *= by;
  reach.pitch *= by;
  reach.roll *= by;
  return reach;
}

/// A polynomial and what it costs.
struct Candidate {
  AttitudePolynomial polynomial;
  double left_out = 0.0;                                     ///< bound on what it neglects, relative
  double seconds = std::numeric_limits<double>::infinity();  ///< an exposure, its share of making the cells included
};

/// Cells that hold the jitter and a part of the drift's extent, in epochs of so many exposures (0: one for all).
/// @param unit  with the slow motion within an epoch
Candidate with_part(const Scene& scene, const Plan& plan, const AttitudeReach& unit, double part, double allowed,
                    std::int64_t epoch = 0) {
  constexpr std::size_t kMostTerms = 32;
  constexpr double kMostBytes = 512.0 * 1024.0 * 1024.0;  // of a detector's maps
  const AttitudeVariance variance = scene.attitude().variance();
  const Attitude jitter{kReach * det::sqrt(variance.yaw), kReach * det::sqrt(variance.pitch),
                        kReach * det::sqrt(variance.roll)};
  const Attitude& drift = scene.attitude_trend().farthest();
  Candidate candidate;
  Attitude& scale = candidate.polynomial.scale;
  scale = {jitter.yaw + part * drift.yaw, jitter.pitch + part * drift.pitch, jitter.roll + part * drift.roll};
  const bool holds_drift = (drift.yaw == 0.0 || scale.yaw > 0.0) && (drift.pitch == 0.0 || scale.pitch > 0.0) &&
                           (drift.roll == 0.0 || scale.roll > 0.0);
  if (!holds_drift) return candidate;
  // Where the drift has brought an exposure to the border of its cell, the motion within it reaches beyond.
  const double beyond = scene.attitude_trend().is_still()
                            ? 0.0
                            : kReach * stretch(scene.summary()) * scene.summary().attitude_rms_in_exposure_px;
  const AttitudeReach reach{unit.yaw * scale.yaw + (scale.yaw > 0.0 ? beyond : 0.0),
                            unit.pitch * scale.pitch + (scale.pitch > 0.0 ? beyond : 0.0),
                            unit.roll * scale.roll + (scale.roll > 0.0 ? beyond : 0.0), unit.slow};
  std::vector<AttitudePowers>& terms = candidate.polynomial.terms;
  terms = choose_attitude_terms(scene.summary().psf.derivatives, reach, allowed, kMostTerms, candidate.left_out);
  const auto pixels = static_cast<double>(scene.detector().size());
  if (terms.empty() || maps_bytes(terms.size(), pixels) > kMostBytes) return candidate;
  // The cells along the drift, each entered once: borders that are crossed in several axes count for each.
  const auto entered = [](double extent, double half_width) { return half_width > 0.0 ? extent / half_width : 0.0; };
  const double cells =
      scene.attitude_trend().is_still()
          ? 0.0
          : 1.0 + entered(drift.yaw, scale.yaw) + entered(drift.pitch, scale.pitch) + entered(drift.roll, scale.roll);
  Plan once = plan;
  once.knobs.jitter = JitterTreatment::kShift;
  const double made = cells / static_cast<double>(scene.mission().simulation.exposures) +
                      (epoch > 0 ? 1.0 / static_cast<double>(epoch) : 0.0);
  const double share = made * static_cast<double>(terms.size());
  candidate.seconds = maps_seconds(terms.size(), pixels) + share * full_frame_seconds(once, scene);
  return candidate;
}

}  // namespace

void plan_jitter(const Scene& scene, double share, Plan& plan) {
  const SceneSummary& s = scene.summary();
  const double flux = s.brightest_target_electrons;
  plan.knobs.jitter = JitterTreatment::kShift;
  if (!(flux > 0.0)) return;
  // The mean position of an exposure is a random quantity: an error of it that is small against the exposure's own
  // noise with all cameras, which it does not share, changes no statistics.
  const double noise = det::sqrt(kVarianceTolerance * s.relative_variance_in_bin(flux) * s.exposures_per_bin);
  const double first_order = s.psf.gradient * s.attitude_rms_px;
  plan.knobs.attitude_steps =
      std::max(plan.knobs.attitude_steps, scene.attitude().steps_for(first_order > 0.0 ? noise / first_order : 1.0));

  const double allowed = share * s.flux_tolerance(flux) / flux;  // relative
  // Both axes: half the curvature times the variance of the motion, and what the next order leaves of it.
  const double second_order =
      s.psf.curvature * s.neighbour_curvature * s.attitude_rms_in_exposure_px * s.attitude_rms_in_exposure_px;
  // Of these the third is of one exposure alone, whose motion is no Gaussian. The factor covers apertures in which the
  // second order of one star cancels that of another (test: AccuracyPromise.IsKeptOnFiveHundredRandomScenes).
  constexpr double kThirdOrder = 1.0;
  const double next_orders =
      std::max(second_order * second_order, kThirdOrder * second_order * det::sqrt(second_order));
  if (second_order <= allowed) {
    plan.jitter_error = flux * second_order;
  } else if (next_orders <= allowed) {
    plan.knobs.jitter = JitterTreatment::kBroadened;
    plan.jitter_error = flux * next_orders;
  } else {
    plan.knobs.jitter = JitterTreatment::kSubSteps;
    plan.jitter_error = flux * second_order / plan.knobs.attitude_steps;
  }
}

namespace {

/// The cheapest polynomial.  @param unit, epoch  as of with_part()
Candidate cheapest(const Scene& scene, const Plan& plan, const AttitudeReach& unit, double allowed,
                   std::int64_t epoch = 0) {
  // The wider a cell, the fewer are made along the drift, and the more terms each needs.
  constexpr double kSmallestPart = 1e-4;
  Candidate best = with_part(scene, plan, unit, 0.0, allowed, epoch);
  if (!scene.attitude_trend().is_still())
    for (double part = 1.0; part > kSmallestPart; part *= 0.5) {
      Candidate candidate = with_part(scene, plan, unit, part, allowed, epoch);
      if (candidate.seconds < best.seconds) best = std::move(candidate);
    }
  return best;
}

/// What the noiseless image of an exposure takes by the plan as it is, its share of what is made for an epoch included.
double image_seconds(const Scene& scene, const Plan& plan) {
  if (!plan.still && plan.knobs.jitter != JitterTreatment::kPolynomial) return full_frame_seconds(plan, scene);
  const std::size_t terms = std::max<std::size_t>(1, plan.knobs.polynomial.terms.size());
  Plan once = plan;
  once.knobs.jitter = JitterTreatment::kShift;
  const double per_exposure = plan.epoch_exposures > 0 ? 1.0 / static_cast<double>(plan.epoch_exposures) : 0.0;
  return static_cast<double>(terms) * per_exposure * full_frame_seconds(once, scene) +
         (plan.still ? 0.0 : maps_seconds(terms, static_cast<double>(scene.detector().size())));
}

}  // namespace

void plan_polynomial(const Scene& scene, double share, Plan& plan) {
  const SceneSummary& s = scene.summary();
  const double flux = s.brightest_target_electrons;
  if (!(flux > 0.0)) return;
  const double allowed = share * s.flux_tolerance(flux) / flux;
  Candidate best = cheapest(scene, plan, per_arcsec(scene), allowed);
  if (!(best.seconds <= full_frame_seconds(plan, scene))) return;
  plan.knobs.jitter = JitterTreatment::kPolynomial;
  plan.knobs.polynomial = std::move(best.polynomial);
  plan.jitter_error = flux * best.left_out;
}

void plan_slow_motion(const Scene& scene, double share, std::int64_t longest, Plan& plan) {
  SlowMotion slow;
  for (const PlannedEffect& planned : plan.effects)
    if (planned.need.needed) {
      slow.px += planned.need.motion.px;
      slow.rate = std::max(slow.rate, planned.need.motion.rate);
    }
  const SceneSummary& s = scene.summary();
  const double flux = s.brightest_target_electrons;
  if (!(slow.px > 0.0) || !(flux > 0.0)) return;
  const double allowed = share * s.flux_tolerance(flux) / flux;
  AttitudeReach unit = per_arcsec(scene);
  // Powers of two, whatever the length of the run, so that a longer run begins with the shorter one.
  constexpr std::int64_t kShortest = 32;
  constexpr std::int64_t kLongest = 1 << 20;
  Candidate best;
  best.seconds = image_seconds(scene, plan);
  std::int64_t epoch = 0;
  for (std::int64_t n = kShortest; n <= kLongest && (longest == 0 || n <= longest); n *= 2) {
    const double half = 0.5 * static_cast<double>(n) * scene.mission().simulation.cycle.value();
    unit.slow = {.px = slow.px, .rate = slow.rate * half};
    Candidate candidate = cheapest(scene, plan, unit, allowed, n);
    if (!(candidate.seconds < best.seconds)) continue;
    best = std::move(candidate);
    epoch = n;
  }
  if (epoch == 0) return;
  plan.epoch_exposures = epoch;
  plan.still = false;
  plan.knobs.jitter = JitterTreatment::kPolynomial;
  plan.knobs.polynomial = std::move(best.polynomial);
  plan.jitter_error = flux * best.left_out;
}

}  // namespace astroid
