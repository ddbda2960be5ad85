#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "astroid/sim/plan.hpp"
#include "plan_cost.hpp"

namespace astroid {

namespace {

constexpr double kMilli = 1e3;
constexpr double kMebi = 1048576.0;
constexpr double kSecondsPerHour = 3600.0;

double ppm_of_brightest(double electrons, const SceneSummary& s) {
  return 1e6 * electrons / s.brightest_target_electrons;
}

}  // namespace

std::string to_text(const Plan& plan, const Scene& scene) {
  const SceneSummary& s = scene.summary();
  std::string out = "What will be computed, and why\n\n";
  out += fmt::format("Pixels     {}\n", plan.pixels);
  out += fmt::format("Stars      {} on or next to the detector, {} of them targets\n", s.stars, scene.targets().size());
  out +=
      fmt::format("PSF        {} (renderer {}: {})\n", scene.psf().description(), plan.renderer, plan.renderer_reason);
  if (const SubPixelRenderer* map = scene.sub_pixel_renderer())
    out += fmt::format("Map        {}; {:.3g} MiB per worker\n", map->description(), map->workspace_bytes() / kMebi);
  out += fmt::format("Attitude   {}\n", scene.attitude().description());
  out += fmt::format(
      "Accuracy   {:.3g} ppm asked for: every flux may be off by the larger of that and 1 % of its own noise in {:.0f} "
      "exposures\n"
      "           of {} camera(s); for the faintest target that is {:.3g} e- per exposure\n\n",
      1e6 * s.accuracy, s.exposures_per_bin, s.cameras, plan.tolerance);
  out += "Effects, in the order of the run\n";
  const bool recalled = plan.still || plan.knobs.jitter == JitterTreatment::kPolynomial;
  for (const PlannedEffect& planned : plan.effects) {
    const EffectSpec& spec = planned.effect->spec();
    const double ms = kMilli * planned.seconds;
    out += fmt::format("  {:<3} {:<23} {:<11} {}\n", planned.need.needed ? "on" : "off", spec.name,
                       to_string(spec.level), planned.need.why);
    if (planned.need.needed) {
      if (ms > 0.0)
        out += fmt::format("      {:<35} about {:.2g} ms per exposure\n", "", ms);
      else if (recalled && spec.level > EffectLevel::kPointing && spec.level <= EffectLevel::kPixelMean)
        out += fmt::format("      {:<35} computed once, with the noiseless image\n", "");
    } else if (planned.need.bias_bound > 0.0 || planned.need.variance_bound > 0.0) {
      out += fmt::format("      {:<35} left out: at most {:.2g} e- of any flux and {:.2g} of its variance\n", "",
                         planned.need.bias_bound, planned.need.variance_bound);
    }
  }
  out += "\nApproximations, each within its share of the accuracy\n";
  out += fmt::format(
      "  stamps    half-width {:.2f} px (brightest) to {:.2f} px (faintest): at most {:.2g} e- of any target\n",
      plan.knobs.stamps.empty() ? 0.0 : plan.knobs.stamps.front().half_width,
      plan.knobs.stamps.empty() ? 0.0 : plan.knobs.stamps.back().half_width, plan.stamp_error);
  out += fmt::format("  PSF       {:.2g} ppm\n", 1e6 * plan.renderer_error);
  if (plan.knobs.jitter == JitterTreatment::kNone) {
    out += "  jitter    none: the noiseless image is computed once\n";
  } else if (plan.knobs.jitter == JitterTreatment::kPolynomial) {
    const std::size_t terms = plan.knobs.polynomial.terms.size();
    out += fmt::format(
        "  jitter    {}, {} terms, their means taken over {} step(s) of an exposure: at most {:.2g} ppm of the\n"
        "            brightest target; {} fixed maps, {:.3g} MiB for all workers\n",
        plan.knobs.polynomial.highest_power_of_time() > 0 ? "polynomial in attitude and time"
                                                          : to_string(plan.knobs.jitter),
        terms, plan.knobs.attitude_steps, ppm_of_brightest(plan.jitter_error, s), terms,
        maps_bytes(terms, static_cast<double>(plan.layout->size())) / kMebi);
    if (const int power = plan.knobs.polynomial.highest_power_of_time(); power > 0)
      out += fmt::format(
          "  slow      stars move by themselves within epochs of {} exposures ({:.3g} h): powers of time up to {} "
          "among\n"
          "            those terms, from images rendered at fixed times of the epoch\n",
          plan.epoch_exposures,
          static_cast<double>(plan.epoch_exposures) * scene.mission().simulation.cycle.value() / kSecondsPerHour,
          power);
  } else {
    out += fmt::format("  jitter    {} with {} step(s) in an exposure: at most {:.2g} ppm of the brightest target\n",
                       to_string(plan.knobs.jitter), plan.knobs.attitude_steps, ppm_of_brightest(plan.jitter_error, s));
  }
  for (const std::string& text : plan.approximations) out += fmt::format("  note      {}\n", text);
  const double exposures =
      static_cast<double>(scene.mission().simulation.exposures) * scene.mission().telescope.simulated_cameras;
  out += fmt::format(
      "\nPredicted  {:.3g} ms per exposure on one core ({:.3g} s of CPU for {:.0f} exposures), {:.3g} MiB per worker\n",
      kMilli * plan.seconds_per_exposure, plan.seconds_per_exposure * exposures, exposures, plan.memory_bytes / kMebi);
  return out;
}

std::string to_json(const Plan& plan, const Scene& scene) {
  const SceneSummary& s = scene.summary();
  nlohmann::ordered_json json;
  json["pixels"] = plan.pixels;
  json["renderer"] = plan.renderer;
  json["renderer_reason"] = plan.renderer_reason;
  json["renderer_error_ppm"] = 1e6 * plan.renderer_error;
  if (const SubPixelRenderer* map = scene.sub_pixel_renderer())
    json["map"] = {{"sub_pixels", map->sub_pixels()},
                   {"cells", map->cells()},
                   {"tiles", map->tiles().size()},
                   {"band_cycles_per_px", map->band()},
                   {"bytes_per_worker", map->workspace_bytes()}};
  json["psf"] = scene.psf().description();
  json["attitude"] = scene.attitude().description();
  json["stars"] = s.stars;
  json["targets"] = scene.targets().size();
  json["accuracy_ppm"] = 1e6 * s.accuracy;
  json["tolerance_electrons"] = plan.tolerance;
  json["noiseless_image_cached"] = plan.still;
  json["jitter"] = {{"treatment", to_string(plan.knobs.jitter)}, {"steps_per_exposure", plan.knobs.attitude_steps}};
  if (plan.knobs.jitter == JitterTreatment::kPolynomial) {
    const Attitude& scale = plan.knobs.polynomial.scale;
    json["jitter"]["powers_of_yaw_pitch_roll_time"] = plan.knobs.polynomial.terms;
    json["jitter"]["cell_half_width_arcsec"] = {scale.yaw, scale.pitch, scale.roll};
  }
  json["errors_electrons"] = {{"stamps", plan.stamp_error}, {"psf", plan.psf_error}, {"jitter", plan.jitter_error}};
  for (const StampTier& tier : plan.knobs.stamps)
    json["stamps"].push_back(
        {{"min_electrons", tier.min_electrons}, {"half_width_px", tier.half_width}, {"stars", tier.stars}});
  for (const PlannedEffect& planned : plan.effects) {
    const EffectSpec& spec = planned.effect->spec();
    json["effects"].push_back({{"name", spec.name},
                               {"level", to_string(spec.level)},
                               {"on", planned.need.needed},
                               {"why", planned.need.why},
                               {"bias_if_skipped_electrons", planned.need.bias_bound},
                               {"variance_if_skipped_relative", planned.need.variance_bound},
                               {"predicted_seconds", planned.seconds},
                               {"source", spec.source}});
  }
  json["approximations"] = plan.approximations;
  json["predicted"] = {{"seconds_per_exposure", plan.seconds_per_exposure},
                       {"memory_bytes_per_worker", plan.memory_bytes}};
  return json.dump(2) + "\n";
}

}  // namespace astroid
