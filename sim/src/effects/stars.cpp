#include "effects/stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
#include "star_lists.hpp"

namespace astroid {

namespace {

PixelPosition displaced(const RenderedStar& star, const Attitude& attitude) {
  const PixelShift shift = displacement(star.motion, attitude);
  return {star.position.x + shift.dx, star.position.y + shift.dy};
}

}  // namespace

EffectNeed Stars::is_needed(const SceneSummary& scene) const {
  if (scene.stars == 0) return {false, "no star of the catalogue falls on the detector", 0.0, 0.0};
  return {true,
          fmt::format("{} stars on the detector, {} of them targets; the brightest ({}) gives {:.4g} e- per exposure",
                      scene.stars, scene.targets, scene.brightest_id, scene.brightest_electrons),
          scene.brightest_electrons, 1.0};
}

void Stars::prepare(CameraState& camera, const PrepareContext& context) const {
  // The images that a polynomial goes through lie up to a cell farther out than any exposure.
  const Attitude& scale = context.knobs.polynomial.scale;
  const Attitude& farthest = context.attitude.farthest;
  const Attitude reach{farthest.yaw + 2.0 * scale.yaw, farthest.pitch + 2.0 * scale.pitch,
                       farthest.roll + 2.0 * scale.roll};
  std::vector<Rectangle> areas;
  for (const Strip& strip : camera.strips) areas.insert(areas.end(), strip.areas.begin(), strip.areas.end());
  auto lists = star_lists(context.scene, context.knobs, areas, reach);
  auto list = lists.begin();
  for (const Strip& strip : camera.strips) {
    const auto end = list + static_cast<std::ptrdiff_t>(strip.areas.size());
    camera.stars.emplace_back(std::move_iterator(list), std::move_iterator(end));
    list = end;
  }
}

void Stars::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const PixelPsf& psf = context.scene.psf();
  const JitterTreatment jitter = context.knobs.jitter;
  const Conditions& conditions = state.conditions;
  const auto steps = static_cast<double>(state.attitude_steps.size());
  const std::span<const Strip> strips = context.camera.strips;
  const auto number = std::ranges::lower_bound(strips, strip.begin, {}, &Strip::begin) - strips.begin();
  const auto& lists = context.camera.stars[static_cast<std::size_t>(number)];
  for (std::size_t a = 0; a < lists.size(); ++a) {
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(strip, a);
    for (const RenderedStar& star : lists[a]) {
      StarLight light{.centre = {}, .electrons = star.electrons * conditions.throughput, .half_width = star.half_width};
      light.motion = {.sxx = conditions.psf_variance, .sxy = 0.0, .syy = conditions.psf_variance};
      light.broadened = conditions.psf_variance > 0.0;
      if (jitter == JitterTreatment::kSubSteps) {
        light.electrons /= steps;
        for (const Attitude& attitude : state.attitude_steps) {
          light.centre = displaced(star, attitude);
          psf.add_star(light, view, state.scratch);
        }
        continue;
      }
      light.centre = displaced(star, state.attitude.mean);
      if (jitter == JitterTreatment::kBroadened) {
        const MotionCovariance motion = motion_covariance(star.motion, state.attitude.covariance);
        light.motion = {light.motion.sxx + motion.sxx, motion.sxy, light.motion.syy + motion.syy};
        light.broadened = true;
      }
      psf.add_star(light, view, state.scratch);
    }
  }
}

}  // namespace astroid
