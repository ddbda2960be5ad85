#include "effects/stars.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {

/// Where a star is during an exposure, or a part of it.
struct Placement {
  PixelPosition centre;
  MotionCovariance motion{};  ///< about the centre
  bool broadened = false;
};

/// Adds `electrons` of light to the pixels of `view` that lie within the star's stamp.
void add_star(const PixelPsf& psf, const Placement& at, double electrons, double half_width,
              const ImageView<double, unit::ExpectedElectrons>& view, ExposureState& state) {
  const Rectangle box = intersect(stamp_box(at.centre, half_width), view.area());
  if (box.empty()) return;
  if (state.stamp.size() < box.size()) state.stamp.resize(box.size());
  const std::span<double> fractions(state.stamp.data(), box.size());
  if (at.broadened) {
    psf.integrate_broadened(at.centre, at.motion, box, fractions, state.scratch);
  } else {
    psf.integrate(at.centre, box, fractions);
  }
  const double* fraction = fractions.data();
  for (int y = box.y0; y < box.y1(); ++y) {
    double* pixel = &view.at(box.x0, y);
    for (int i = 0; i < box.nx; ++i) pixel[i] += electrons * fraction[i];
    fraction += box.nx;
  }
}

PixelPosition displaced(const SceneStar& star, const Attitude& attitude) {
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

void Stars::apply(ExposureState& state, const EffectContext& context) const {
  const Scene& scene = context.scene;
  const PixelPsf& psf = scene.psf();
  const JitterTreatment jitter = context.knobs.jitter;
  const auto steps = static_cast<double>(state.attitude_steps.size());
  for (std::size_t region = 0; region < state.expected.layout().regions().size(); ++region) {
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(region);
    for (const std::uint32_t index : context.knobs.stars_of_region[region]) {
      const SceneStar& star = scene.stars()[index];
      const double half_width = context.knobs.stamp_half_width(star.electrons);
      if (jitter == JitterTreatment::kSubSteps) {
        for (const Attitude& attitude : state.attitude_steps)
          add_star(psf, {.centre = displaced(star, attitude)}, star.electrons / steps, half_width, view, state);
        continue;
      }
      Placement at{.centre = displaced(star, state.attitude.mean)};
      if (jitter == JitterTreatment::kBroadened) {
        at.motion = motion_covariance(star.motion, state.attitude.covariance);
        at.broadened = true;
      }
      add_star(psf, at, star.electrons, half_width, view, state);
    }
  }
}

}  // namespace astroid
