#include "effects/pick_up_noise.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed PickUpNoise::is_needed(const SceneSummary& scene) const {
  const double amplitude = scene.mission->ccd.electronics.pick_up.amplitude;
  if (amplitude <= 0.0) return {false, "no interference is picked up", 0.0, 0.0};
  // At worst the wave is as long as the aperture is wide: all of its pixels have the same phase.
  const double electrons = amplitude * scene.mission->ccd.gain.value() * scene.aperture_pixels;
  const double variance = 0.5 * electrons * electrons;
  const double rest = scene.faintest_target_electrons + scene.pixel_noise_variance;
  const double ratio = rest > 0.0 ? variance / rest : 1.0;
  return {ratio > kVarianceTolerance,
          fmt::format("an amplitude of {:.4g} ADU adds up to {:.4g} e-² to {:.3g} px; the faintest target has {:.4g} "
                      "e-² or more",
                      amplitude, variance, scene.aperture_pixels, rest),
          0.0, ratio};
}

void PickUpNoise::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const PickUpSettings& wave = context.scene.mission().ccd.electronics.pick_up;
  const double phase = kTurn * uniform_at_step(context.stream, {.step = static_cast<std::uint64_t>(state.number)});
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle& area = strip.areas[a];
    const auto columns = static_cast<std::size_t>(area.nx);
    // Rows and columns apart, by the addition theorem: a sine each, not one a pixel.
    state.scratch.resize(2 * columns);
    const std::span<double> sines = std::span(state.scratch).first(columns);
    const std::span<double> cosines = std::span(state.scratch).last(columns);
    for (std::size_t i = 0; i < columns; ++i) {
      const double angle = kTurn * wave.column_frequency * static_cast<double>(area.x0 + static_cast<int>(i));
      sines[i] = det::sin(angle);
      cosines[i] = det::cos(angle);
    }
    const auto view = state.analog.view(strip, a);
    for (int y = area.y0; y < area.y1(); ++y) {
      const double angle = kTurn * wave.row_frequency * static_cast<double>(y) + phase;
      const double sine = wave.amplitude * det::sin(angle);
      const double cosine = wave.amplitude * det::cos(angle);
      const auto row = view.row(y);
      for (std::size_t i = 0; i < columns; ++i) row[i] += sine * cosines[i] + cosine * sines[i];
    }
  }
}

}  // namespace astroid
