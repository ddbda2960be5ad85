#include "effects/stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/rolling_shutter.hpp"
#include "effects/star_light.hpp"
#include "star_lists.hpp"

namespace astroid {

EffectNeed Stars::is_needed(const SceneSummary& scene) const {
  if (scene.stars == 0) return {false, "no star of the catalogue falls on the detector", 0.0, 0.0};
  if (choose_renderer(*scene.mission).renderer == Renderer::kSubPixel)
    return {false, "the sub-pixel renderer makes them", 0.0, 0.0};
  return {true,
          fmt::format("{} stars on the detector, {} of them targets; the brightest ({}) gives {:.4g} e- per exposure",
                      scene.stars, scene.targets, scene.brightest_id, scene.brightest_electrons),
          scene.brightest_electrons, 1.0};
}

void Stars::prepare(CameraState& camera, const PrepareContext& context) const {
  camera.stars = star_lists(context, camera.strips, context.knobs.variables ? StarChoice::kConstant : StarChoice::kAll);
}

void Stars::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const PixelPsf& psf = recorded_psf(context);
  const std::span<const Strip> strips = context.camera.strips;
  const auto number = std::ranges::lower_bound(strips, strip.begin, {}, &Strip::begin) - strips.begin();
  const auto& lists = context.camera.stars[static_cast<std::size_t>(number)];
  for (std::size_t a = 0; a < lists.size(); ++a) {
    look_at_row(state, strip.areas[a].y0);
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(strip, a);
    for (const RenderedStar& star : lists[a])
      for_each_light(star, state, context.knobs.jitter,
                     [&](const StarLight& light) { psf.add_star(light, view, state.scratch); });
  }
}

}  // namespace astroid
