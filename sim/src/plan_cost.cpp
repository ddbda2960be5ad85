#include "plan_cost.hpp"

#include <string_view>

#include "star_lists.hpp"

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
constexpr double kAnalyticStar = 30.0;       ///< ns a star
constexpr double kAnalyticPixel = 0.6;       ///< ns a stamp pixel
constexpr double kAnalyticBroadening = 1.6;  ///< one more profile an axis for the correlation
constexpr double kPrfStar = 30.0;
constexpr double kPrfPixel = 4.0;  ///< ns a stamp pixel, 16 taps
constexpr double kPrfBroadening = 5.0;
constexpr double kMapPixel = 0.15;  ///< ns a pixel of one map
constexpr double kNanosecond = 1e-9;

/// Of one star, at one place.
double star_cost(const Plan& plan, double electrons) {
  const double side = 2.0 * plan.knobs.stamp_half_width(electrons) + 1.0;
  return plan.renderer == "analytic" ? kAnalyticStar + side * side * kAnalyticPixel
                                     : kPrfStar + side * side * kPrfPixel;
}

/// How many times a star is rendered for one exposure.
double renderings(const Plan& plan) {
  switch (plan.knobs.jitter) {
    case JitterTreatment::kBroadened:
      return plan.renderer == "analytic" ? kAnalyticBroadening : kPrfBroadening;
    case JitterTreatment::kSubSteps:
      return plan.knobs.attitude_steps;
    default:
      return 1.0;
  }
}

double stars_cost(const Plan& plan, const Scene& scene) {
  double nanoseconds = 0.0;
  for (const auto& stars : star_lists(scene, plan.knobs, scene.layout()->regions(), {}))
    for (const RenderedStar& star : stars) nanoseconds += star_cost(plan, star.electrons);
  return nanoseconds * renderings(plan);
}

/// Whether the noiseless image is recalled rather than rendered.
bool recalls(const Plan& plan) {
  return plan.still || plan.knobs.jitter == JitterTreatment::kPolynomial;
}

}  // namespace

double full_frame_seconds(const Plan& plan, const Scene& scene) {
  double nanoseconds = 0.0;
  for (const SceneStar& star : scene.stars()) nanoseconds += star_cost(plan, star.electrons);
  return kNanosecond * nanoseconds * renderings(plan);
}

double maps_seconds(std::size_t terms, double pixels) {
  return kNanosecond * pixels * (kClear + kMapPixel * static_cast<double>(terms));
}

double maps_bytes(std::size_t terms, double pixels) {
  return pixels * static_cast<double>(sizeof(double) + (terms - 1) * sizeof(float));
}

double predicted_seconds(const PlannedEffect& effect, const Plan& plan, const Scene& scene) {
  const EffectSpec& spec = effect.effect->spec();
  const auto pixels = static_cast<double>(scene.layout()->size());
  if (!effect.need.needed) return 0.0;
  if (recalls(plan) && spec.level <= EffectLevel::kPixelMean) {
    const bool moves = plan.knobs.jitter == JitterTreatment::kPolynomial;
    return spec.name == "stars" && moves ? maps_seconds(plan.knobs.polynomial.terms.size(), pixels) : 0.0;
  }
  if (spec.name == "stars") return kNanosecond * stars_cost(plan, scene);
  for (const PixelCost& cost : kPixelCosts)
    if (cost.effect == spec.name) return kNanosecond * cost.nanoseconds * pixels;
  return 0.0;
}

double predicted_seconds(const Plan& plan, const Scene& scene) {
  double seconds = kNanosecond * kClear * static_cast<double>(scene.layout()->size());
  for (const PlannedEffect& effect : plan.effects) seconds += predicted_seconds(effect, plan, scene);
  return seconds;
}

double predicted_memory(const Plan& plan, const Scene& scene) {
  double bytes_per_pixel = sizeof(float) + sizeof(std::uint8_t);  // the frame
  if (!recalls(plan)) bytes_per_pixel += sizeof(double);          // the noiseless image
  if (plan.runs("full-well")) bytes_per_pixel += sizeof(double);  // drawn electrons, column by column
  return bytes_per_pixel * static_cast<double>(scene.layout()->size());
}

}  // namespace astroid
