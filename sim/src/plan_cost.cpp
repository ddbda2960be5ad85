#include "plan_cost.hpp"

#include <string_view>

namespace astroid {

namespace {

/// Nanoseconds a pixel and exposure, measured with tests/bench (BM_Effects) on one core of the machine named in
/// docs/performance.md, which has AVX-512; on the x86-64-v2 baseline noise takes about three times as long.
struct PixelCost {
  std::string_view effect;
  double nanoseconds;
};
constexpr PixelCost kPixelCosts[] = {{"sky", 0.3},          {"prnu", 0.4},      {"dark-current", 0.4},
                                     {"photon-noise", 5.4}, {"full-well", 1.2}, {"readout-noise", 2.5},
                                     {"gain", 1.2},         {"bias", 0.3},      {"adc", 1.3}};
constexpr double kClear = 0.3;  ///< ns a pixel: the noiseless image is set to zero, or copied where nothing moves
constexpr double kAnalyticEdge = 15.0;  ///< ns an edge of a pixel column or row (one erf)
constexpr double kAnalyticPixel = 0.6;  ///< ns a stamp pixel
constexpr double kPrfPixel = 8.0;       ///< ns a stamp pixel, 16 taps
constexpr double kNanosecond = 1e-9;

double stars_cost(const Plan& plan, const Scene& scene) {
  double nanoseconds = 0.0;
  for (const auto& stars : plan.knobs.stars_of_region)
    for (const std::uint32_t i : stars) {
      const double side = 2.0 * plan.knobs.stamp_half_width(scene.stars()[i].electrons) + 1.0;
      nanoseconds += plan.renderer == "analytic" ? 2.0 * (side + 1.0) * kAnalyticEdge + side * side * kAnalyticPixel
                                                 : side * side * kPrfPixel;
    }
  constexpr double kBroadening = 2.0;  // two more profiles, or four more stamps
  if (plan.knobs.jitter == JitterTreatment::kBroadened) nanoseconds *= kBroadening;
  return nanoseconds * (plan.knobs.jitter == JitterTreatment::kSubSteps ? plan.knobs.attitude_steps : 1);
}

}  // namespace

double predicted_seconds(const PlannedEffect& effect, const Plan& plan, const Scene& scene) {
  const EffectSpec& spec = effect.effect->spec();
  if (!effect.need.needed || (plan.still && spec.level <= EffectLevel::kPixelMean)) return 0.0;
  if (spec.name == "stars") return kNanosecond * stars_cost(plan, scene);
  for (const PixelCost& cost : kPixelCosts)
    if (cost.effect == spec.name) return kNanosecond * cost.nanoseconds * static_cast<double>(scene.layout()->size());
  return 0.0;
}

double predicted_seconds(const Plan& plan, const Scene& scene) {
  double seconds = kNanosecond * kClear * static_cast<double>(scene.layout()->size());
  for (const PlannedEffect& effect : plan.effects) seconds += predicted_seconds(effect, plan, scene);
  return seconds;
}

double predicted_memory(const Plan& /*plan*/, const Scene& scene) {
  constexpr double kBytesPerPixel = 3.0 * sizeof(double) + sizeof(float) + sizeof(std::uint8_t);
  return kBytesPerPixel * static_cast<double>(scene.layout()->size());
}

}  // namespace astroid
