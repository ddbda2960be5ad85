#include "effects/variable_stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/rolling_shutter.hpp"
#include "effects/star_light.hpp"
#include "star_lists.hpp"

namespace astroid {

EffectNeed VariableStars::is_needed(const SceneSummary& scene) const {
  if (scene.variable_stars == 0) return {false, "no star on the detector varies", 0.0, 0.0};
  // A variable star may lie in the mask of any target.
  const double tolerance = scene.tightest_tolerance();
  return {scene.largest_variation > tolerance,
          fmt::format("{} stars vary, by up to {:.4g} e- per exposure; the tightest flux tolerance is {:.3g} e-",
                      scene.variable_stars, scene.largest_variation, tolerance),
          scene.largest_variation, 0.0};
}

void VariableStars::prepare(CameraState& camera, const PrepareContext& context) const {
  if (context.knobs.variables) camera.variables = star_lists(context, camera.strips, StarChoice::kVariable);
}

void VariableStars::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  if (!context.knobs.variables) return;  // they shine among the others, constantly
  const Scene& scene = context.scene;
  const PixelPsf& psf = recorded_psf(context);
  const double half = 0.5 * scene.mission().simulation.exposure_time.value();
  const double middle = scene.mission_time(state.exposure).value();
  // The maps of a polynomial hold the constant stars; of these, the motion about the mean broadens the image.
  const JitterTreatment jitter =
      context.knobs.jitter == JitterTreatment::kPolynomial ? JitterTreatment::kBroadened : context.knobs.jitter;
  const std::span<const Strip> strips = context.camera.strips;
  const auto number = std::ranges::lower_bound(strips, strip.begin, {}, &Strip::begin) - strips.begin();
  const auto& lists = context.camera.variables[static_cast<std::size_t>(number)];
  for (std::size_t a = 0; a < lists.size(); ++a) {
    if (lists[a].empty()) continue;
    look_at_row(state, strip.areas[a].y0);
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(strip, a);
    for (RenderedStar star : lists[a]) {
      const Variability& variability = scene.variables()[static_cast<std::size_t>(star.variability)].variability;
      // All of a star shines as in its own row: what others see of it is exposed a few line times off.
      const double exposed = middle + star.position.y * state.line_time.value();
      star.electrons *= variability.mean(exposed - half, exposed + half);
      for_each_light(star, state, jitter, [&](const StarLight& light) { psf.add_star(light, view, state.scratch); });
    }
  }
}

}  // namespace astroid
