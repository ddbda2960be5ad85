#include "effects/pixel_readout_noise.hpp"

#include <vector>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/math.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"
#include "effects/pixel_pattern.hpp"

namespace astroid {

namespace {
constexpr std::uint16_t kPatternDraw = 1;  // draw 0 is the noise itself
}

EffectNeed PixelReadoutNoise::is_needed(const SceneSummary& scene) const {
  const double rms = scene.mission->ccd.readout_noise.value();
  if (rms <= 0.0) return {false, "the readout is noiseless (readout noise 0)", 0.0, 0.0};
  return noise_need(scene, rms * fitted_readout_factor(*scene.mission), "e- rms per pixel after the fit of its reads");
}

void PixelReadoutNoise::prepare(CameraState& camera, const PrepareContext& context) const {
  const double spread = context.scene.mission().cmos.noise_rms;
  if (spread <= 0.0) return;
  camera.cmos.readout_noise = Plane<float, unit::Relative>(camera.layout);
  // The mean square of exp(s n - s²) is exp(-2 s²) exp(2 s²) = 1.
  draw_fixed_pattern(
      context.stream, camera.cmos.readout_noise, [&](double normal) { return det::exp(spread * (normal - spread)); },
      kPatternDraw);
}

void PixelReadoutNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const Mission& mission = context.scene.mission();
  const double rms = mission.ccd.readout_noise.value() / mission.ccd.gain.value();
  const std::span<double> analog = state.analog.pixels(strip);
  PixelPlaces places = noise_of(strip, state.number);
  places.read = static_cast<std::uint16_t>(state.read);
  if (context.camera.cmos.readout_noise.empty()) {
    add_pixel_normals(context.stream, places, rms, analog);
    return;
  }
  const std::span<const float> factor = context.camera.cmos.readout_noise.pixels().subspan(strip.begin, strip.size());
  state.normals.resize(strip.size());
  pixel_normals(context.stream, places, state.normals);
  for (std::size_t i = 0; i < analog.size(); ++i)
    analog[i] += rms * (static_cast<double>(factor[i]) * static_cast<double>(state.normals[i]));
}

}  // namespace astroid
