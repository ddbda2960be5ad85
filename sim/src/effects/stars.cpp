#include "effects/stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
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
  std::vector<Rectangle> areas;
  for (const Strip& strip : camera.strips) areas.insert(areas.end(), strip.areas.begin(), strip.areas.end());
  auto lists = star_lists(context.scene, context.knobs, areas, farthest_attitude(context),
                          context.knobs.variables ? StarChoice::kConstant : StarChoice::kAll);
  auto list = lists.begin();
  for (const Strip& strip : camera.strips) {
    const auto end = list + static_cast<std::ptrdiff_t>(strip.areas.size());
    camera.stars.emplace_back(std::move_iterator(list), std::move_iterator(end));
    list = end;
  }
}

void Stars::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  // Sensitivity within the pixel is a part of what is recorded of a star.
  const bool left_out = has_intra_pixel_response(context.scene.mission()) && !context.camera.intra_pixel;
  const PixelPsf& psf = left_out ? context.scene.optical_psf() : context.scene.psf();
  const std::span<const Strip> strips = context.camera.strips;
  const auto number = std::ranges::lower_bound(strips, strip.begin, {}, &Strip::begin) - strips.begin();
  const auto& lists = context.camera.stars[static_cast<std::size_t>(number)];
  for (std::size_t a = 0; a < lists.size(); ++a) {
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(strip, a);
    for (const RenderedStar& star : lists[a])
      for_each_light(star, state, context.knobs.jitter,
                     [&](const StarLight& light) { psf.add_star(light, view, state.scratch); });
  }
}

}  // namespace astroid
