#include "effects/cosmic_rays.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {

int reads_of(const Mission& mission) {
  return mission.simulation.type == DetectorType::kCmos ? mission.cmos.reads : 1;
}

}  // namespace

CosmicRayModel cosmic_ray_model(const Mission& mission, int reads) {
  constexpr double kCentimetresPerMicrometre = 1e-4;
  const CosmicRaySettings& settings = mission.ccd.cosmic_rays;
  const double side = mission.ccd.pixel_size * kCentimetresPerMicrometre;
  CosmicRayModel model;
  model.hits_per_pixel = settings.rate * side * side * mission.simulation.cycle.value() / reads;
  model.is_slab = settings.model == CosmicRayKind::kSlab;
  model.charge_location = settings.charge_location.value();
  model.charge_scale = settings.charge_scale.value();
  model.charge_shape = settings.charge_shape;
  model.thickness = settings.thickness / mission.ccd.pixel_size;
  model.electrons_per_path = settings.path_charge * mission.ccd.pixel_size;
  model.fluctuation = settings.fluctuation;
  model.longest_track = settings.longest_track.value();
  return model;
}

EffectNeed CosmicRays::is_needed(const SceneSummary& scene) const {
  const CosmicRayModel model = cosmic_ray_model(*scene.mission, 1);
  if (model.hits_per_pixel <= 0.0) return {false, "no particle hits the detector (CosmicRays/Rate 0)", 0.0, 0.0};
  const CosmicCharge charge = charge_of(model);
  // Every particle that may touch an aperture, with all its charge.
  const double hits = model.hits_per_pixel * (scene.aperture_pixels + 2.0 * reach_of(model) * reach_of(model));
  const double bias = hits * charge.mean;
  const double least_variance = scene.faintest_target_electrons + scene.pixel_noise_variance - scene.background;
  const double variance = hits * (charge.mean * charge.mean + charge.variance);
  const double variance_ratio = least_variance > 0.0 ? variance / least_variance : 1.0;
  return {
      bias > scene.tightest_tolerance() || variance_ratio > kVarianceTolerance,
      fmt::format("{:.3g} particles of {:.4g} e- hit a pixel in a cycle, which gives an aperture up to {:.3g} e- an "
                  "exposure; the tightest flux tolerance is {:.3g} e-",
                  model.hits_per_pixel, charge.mean, bias, scene.tightest_tolerance()),
      bias, variance_ratio};
}

void CosmicRays::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const CosmicRayModel model = cosmic_ray_model(mission, reads_of(mission));
  if (model.hits_per_pixel <= 0.0) return;
  const CosmicTime time{static_cast<std::uint32_t>(state.number), static_cast<std::uint16_t>(state.read)};
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const auto electrons = state.sampled.view(strip, a);
    const ImageView<std::uint8_t, unit::Flags> flags{state.computed().flags.pixels().data() + strip.area_begins[a],
                                                     strip.areas[a], static_cast<std::size_t>(strip.areas[a].nx)};
    add_cosmic_rays(model, context.stream, time, electrons, &flags);
  }
}

}  // namespace astroid
