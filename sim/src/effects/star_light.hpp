// What a star is in one exposure: where it is, how bright, and how it moves.
#pragma once

#include <utility>

#include "astroid/sim/effect.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

inline PixelPosition displaced(const RenderedStar& star, const Conditions& conditions, const Attitude& attitude) {
  const PixelShift aberration = star.aberration.displacement(conditions.velocity);
  const PixelShift shift = displacement(star.motion, attitude);
  return {star.position.x + aberration.dx + shift.dx, star.position.y + aberration.dy + shift.dy};
}

/// Calls add(StarLight) for a star: once, or once for every step of the attitude, as the plan has it.
template <class Add>
void for_each_light(const RenderedStar& star, const ExposureState& state, JitterTreatment jitter, Add&& add) {
  const Conditions& conditions = state.conditions;
  StarLight light{.centre = {}, .electrons = star.electrons * conditions.throughput, .half_width = star.half_width};
  light.motion = {.sxx = conditions.psf_variance, .sxy = 0.0, .syy = conditions.psf_variance};
  light.broadened = conditions.psf_variance > 0.0;
  if (jitter == JitterTreatment::kSubSteps) {
    light.electrons /= static_cast<double>(state.attitude_steps.size());
    for (const Attitude& attitude : state.attitude_steps) {
      light.centre = displaced(star, conditions, attitude);
      add(std::as_const(light));
    }
    return;
  }
  light.centre = displaced(star, conditions, state.attitude.mean);
  if (jitter == JitterTreatment::kBroadened) {
    const MotionCovariance motion = motion_covariance(star.motion, state.attitude.covariance);
    light.motion = {light.motion.sxx + motion.sxx, motion.sxy, light.motion.syy + motion.syy};
    light.broadened = true;
  }
  add(std::as_const(light));
}

/// The PSF that stars are made with: with the response within the pixel that all pixels share, unless that effect is
/// off.
inline const PixelPsf& recorded_psf(const EffectContext& context) {
  const bool left_out = has_intra_pixel_response(context.scene.mission()) && !context.camera.intra_pixel;
  return left_out ? context.scene.optical_psf() : context.scene.psf();
}

}  // namespace astroid
