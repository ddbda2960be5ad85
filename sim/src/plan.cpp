#include "astroid/sim/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "astroid/core/digitise.hpp"
#include "astroid/core/math.hpp"
#include "astroid/sim/accuracy_shares.hpp"
#include "astroid/sim/effect_table.hpp"
#include "plan_cost.hpp"
#include "plan_memory.hpp"
#include "plan_motion.hpp"
#include "reference_pixels.hpp"

namespace astroid {

namespace {

/// A target's aperture may touch the wings of this many equally bright neighbours.
constexpr double kNeighbours = 4.0;
/// A recalled image that changes more often than this is not worth keeping.
constexpr std::int64_t kFewExposures = 30;
/// Flux ratio of one magnitude, the width of a stamp tier.
constexpr double kTier = 2.51188643150958;

/// Stamps so large that what lies outside them stays below the truncation's share of every target's tolerance.
std::vector<StampTier> plan_stamps(const Scene& scene, double share, double& error) {
  const SceneSummary& s = scene.summary();
  const double fixed = scene.mission().psf.stamp_half_width.value();
  std::map<int, StampTier, std::greater<>> tiers;
  for (const SceneStar& star : scene.stars()) {
    if (!(star.electrons > 0.0)) continue;
    const int tier = static_cast<int>(std::floor(det::log(star.electrons) / det::log(kTier)));
    StampTier& t = tiers[tier];
    t.min_electrons = det::pow(kTier, tier);
    ++t.stars;
  }
  std::vector<StampTier> stamps;
  error = 0.0;
  for (auto& [number, tier] : tiers) {
    const double brightest = tier.min_electrons * kTier;
    const double own = share * s.flux_tolerance(tier.min_electrons) / brightest;
    const double neighbour = share * s.tightest_tolerance() / (kNeighbours * brightest);
    constexpr double kLargestLoss = 0.5;
    constexpr double kSmallestLoss = 1e-13;  // beyond it the wings are below rounding
    const double lost = std::clamp(std::min(own, neighbour), kSmallestLoss, kLargestLoss);
    tier.half_width = fixed > 0.0 ? fixed : scene.psf().stamp_half_width(lost);
    stamps.push_back(tier);
  }
  error = share * s.tightest_tolerance();
  return stamps;
}

/// Stamps of stars that are broadened, by their motion within an exposure or as the PSF breathes.
void widen_stamps(const Scene& scene, Plan& plan) {
  if (scene.mission().psf.stamp_half_width.value() > 0.0) return;
  constexpr double kRestless = 2.0;  // an exposure's motion over its rms
  constexpr double kWidths = 8.0;    // of a Gaussian, that a stamp is wide at most
  const double motion =
      plan.knobs.jitter == JitterTreatment::kBroadened ? kRestless * scene.summary().attitude_rms_in_exposure_px : 0.0;
  const double blur = plan.runs("breathing") ? scene.mission().psf.breathing.amplitude.value() : 0.0;
  for (StampTier& tier : plan.knobs.stamps)
    tier.half_width = det::hypot(tier.half_width, kWidths * det::hypot(motion, blur));
}

std::string describe_delivered(const Scene& scene) {
  const CcdSettings& ccd = scene.mission().ccd;
  if (ccd.window > 0)
    return fmt::format("{} windows of {} x {} px ({} px in all) of the {} x {} px detector",
                       scene.layout()->exposed_regions().size(), ccd.window, ccd.window, scene.layout()->size(),
                       ccd.columns, ccd.rows);
  if (ccd.has_sub_field)
    return fmt::format("sub-field of {} x {} px from ({}, {}) of the {} x {} px detector", ccd.sub_columns,
                       ccd.sub_rows, ccd.sub_x0, ccd.sub_y0, ccd.columns, ccd.rows);
  return fmt::format("full frame of {} x {} px", ccd.columns, ccd.rows);
}

std::string describe_pixels(const Scene& scene, const Plan& plan) {
  std::string text = describe_delivered(scene);
  if (plan.layout != scene.layout())
    text +=
        fmt::format("; {} px are computed, since charge and light of those outside reach them", plan.layout->size());
  return text;
}

/// A library or map that is not as fine as the accuracy needs: as fine as it may get, or as the configuration says.
void note_coarse_psf(const Scene& scene, Plan& plan) {
  const double share = kAccuracyShares.psf * scene.summary().accuracy;
  if (plan.renderer_error <= share) return;
  plan.approximations.push_back(fmt::format(
      "the accuracy asked for is not kept: the PSF errs by {:.2g} ppm, more than its share of {:.2g} ppm; {}",
      1e6 * plan.renderer_error, 1e6 * share,
      scene.sub_pixel_renderer() != nullptr ? "Simulation/SubPixels can be larger"
                                            : "more PSF/Phases or the renderer subpixel may keep it"));
}

/// Rounding is noise of gain / sqrt(12) only where something blurs its steps (N25).
void note_coarse_converter(const Scene& scene, std::vector<std::string>& approximations) {
  constexpr double kLeastNoise = 0.5;  // ADU
  const SceneSummary& s = scene.summary();
  const double gain = scene.mission().ccd.gain.value();
  const double quantisation = gain / kSqrt12;
  const double noise = det::sqrt(std::max(0.0, s.pixel_noise_variance - quantisation * quantisation)) / gain;
  if (noise >= kLeastNoise) return;
  approximations.push_back(fmt::format(
      "the noise of a dark pixel is {:.3g} ADU: below {} ADU the error of rounding depends on the signal and "
      "is not the noise of gain / sqrt(12) that is predicted",
      noise, kLeastNoise));
}

}  // namespace

std::string_view to_string(JitterTreatment treatment) {
  switch (treatment) {
    case JitterTreatment::kNone:
      return "none";
    case JitterTreatment::kShift:
      return "shift";
    case JitterTreatment::kBroadened:
      return "shift and broadening";
    case JitterTreatment::kSubSteps:
      return "sub-steps";
    case JitterTreatment::kPolynomial:
      return "polynomial in the attitude";
  }
  return "?";
}

double PlanKnobs::stamp_half_width(double electrons) const {
  for (const StampTier& tier : stamps)
    if (electrons >= tier.min_electrons) return tier.half_width;
  return stamps.empty() ? 0.0 : stamps.back().half_width;
}

bool Plan::runs(std::string_view effect) const {
  return std::ranges::any_of(effects,
                             [&](const PlannedEffect& e) { return e.effect->spec().name == effect && e.need.needed; });
}

namespace {

/// The pixels that the delivered ones depend on, through every effect that runs.
std::shared_ptr<const PixelLayout> plan_layout(const Scene& scene, const Plan& plan) {
  const PixelLayout& delivered = *scene.layout();
  const std::span<const Rectangle> exposed = delivered.exposed_regions();
  std::vector<Rectangle> regions(exposed.begin(), exposed.end());
  for (auto planned = plan.effects.rbegin(); planned != plan.effects.rend(); ++planned) {
    if (!planned->need.needed) continue;
    planned->effect->support(scene, regions);
    // More than the whole detector is never needed.
    std::size_t pixels = 0;
    for (const Rectangle& region : regions) pixels += region.size();
    if (pixels > scene.detector().size()) regions = {scene.detector()};
  }
  if (std::ranges::equal(regions, exposed)) return scene.layout();
  const std::vector<Rectangle> reference =
      reference_regions(regions, scene.detector(), scene.mission().ccd.reference, scene.mission().ccd.nodes.count);
  return std::make_shared<const PixelLayout>(std::move(regions), reference);
}

/// @param motion  whether what moves stars smoothly counts
std::int64_t plan_epochs(const Scene& scene, const Plan& plan, bool motion) {
  double steady = std::numeric_limits<double>::infinity();
  for (const PlannedEffect& planned : plan.effects)
    if (planned.need.needed && (motion || planned.need.motion == SlowMotion{}))
      steady = std::min(steady, planned.need.steady.value());
  if (std::isinf(steady)) return 0;
  // Whatever the length of the run, so that a longer run begins with the shorter one.
  constexpr double kMost = 1e9;
  return static_cast<std::int64_t>(std::clamp(steady / scene.mission().simulation.cycle.value(), 1.0, kMost));
}

}  // namespace

double Plan::place_in_epoch(std::int64_t exposure) const {
  if (epoch_exposures <= 0 || knobs.polynomial.highest_power_of_time() == 0) return 0.0;
  const std::int64_t within = exposure - epoch(exposure) * epoch_exposures;
  return static_cast<double>(2 * within - (epoch_exposures - 1)) / static_cast<double>(epoch_exposures);
}

Conditions conditions_of(const Plan& plan, const Scene& scene, std::int64_t epoch, double place) {
  const std::int64_t length = std::max<std::int64_t>(1, plan.epoch_exposures);
  const double middle = static_cast<double>(epoch * length) + 0.5 * static_cast<double>(length - 1) +
                        0.5 * place * static_cast<double>(length);
  const SimulationSettings& simulation = scene.mission().simulation;
  const Seconds time = simulation.stagger + (middle * simulation.cycle + 0.5 * simulation.exposure_time);
  Conditions conditions;
  for (const PlannedEffect& planned : plan.effects)
    if (planned.need.needed) planned.effect->set_conditions(scene, time, conditions);
  return conditions;
}

Plan make_plan(const Scene& scene, const CostFactors& costs, int least_attitude_steps) {
  Plan plan;
  plan.knobs.attitude_steps = least_attitude_steps;
  const SceneSummary& summary = scene.summary();
  bool moves = false;
  for (const auto& effect : effect_table(scene.mission().simulation.type)) {
    PlannedEffect planned{.effect = effect.get(), .need = effect->is_needed(summary)};
    // What reads the attitude makes something else of it, but only where something moves.
    const EffectSpec& spec = effect->spec();
    const bool moving = (spec.writes & plane_bit::kAttitude) != 0 && (spec.reads & plane_bit::kAttitude) == 0;
    moves = moves || (planned.need.needed && moving);
    plan.effects.push_back(std::move(planned));
  }
  plan.reads = scene.mission().simulation.type == DetectorType::kCmos ? scene.mission().cmos.reads : 1;
  plan.layout = plan_layout(scene, plan);
  plan.epoch_exposures = plan_epochs(scene, plan, true);
  // Images that are used a few times only are rendered for each exposure instead.
  const bool steady = plan.epoch_exposures == 0 || plan.epoch_exposures >= kFewExposures;
  plan.still = !moves && steady;
  plan.tolerance = summary.tightest_tolerance();
  const SubPixelRenderer* map = scene.sub_pixel_renderer();
  plan.renderer = to_string(scene.renderer().renderer);
  plan.renderer_reason = scene.renderer().why;
  plan.renderer_error = map != nullptr ? map->predicted_error() : scene.psf().approximation_error();
  plan.psf_error = plan.renderer_error * summary.brightest_target_electrons;
  plan.knobs.variables = plan.runs("variable-stars");
  plan.knobs.stamps = plan_stamps(scene, kAccuracyShares.stamps, plan.stamp_error);
  if (moves) plan_jitter(scene, kAccuracyShares.jitter, plan);
  if (moves) plan_bands(scene, plan);
  if (moves && steady) plan_polynomial(scene, kAccuracyShares.jitter, plan);
  plan_slow_motion(scene, kAccuracyShares.jitter, plan_epochs(scene, plan, false), plan);
  widen_stamps(scene, plan);
  plan_memory(scene, plan);
  plan.pixels = describe_pixels(scene, plan);
  note_coarse_converter(scene, plan.approximations);
  note_coarse_psf(scene, plan);
  if (map != nullptr && plan.knobs.variables && scene.mission().psf.intra_pixel.flat > 0.0)
    plan.approximations.emplace_back(
        "stars that vary see the sensitivity that all pixels share, not what the cells of each have of their own");
  predict_times(plan, scene, costs);
  plan.memory_bytes = predicted_memory(plan, scene);
  return plan;
}

}  // namespace astroid
