#include "effects/flat_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/power_law_field.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed FlatField::is_needed(const SceneSummary& scene) const {
  const FlatFieldSettings& flat = scene.mission->ccd.flat_field;
  if (flat.rms <= 0.0) return {false, "there is no large-scale pattern of sensitivity (FlatField/RMS 0)", 0.0, 0.0};
  return response_need(
      scene, flat.rms,
      fmt::format("a flat field with a spectrum f^-{:.3g} and {:.3g} % rms", flat.exponent, 100.0 * flat.rms));
}

void FlatField::prepare(CameraState& camera, const PrepareContext& context) const {
  const FlatFieldSettings& flat = context.scene.mission().ccd.flat_field;
  const Rectangle detector = context.scene.detector();
  const PowerLawField field(context.stream, detector.nx, detector.ny, flat.exponent, flat.rms);
  camera.flat_field = Plane<float, unit::Relative>(camera.layout);
  std::ranges::fill(camera.flat_field.pixels(), 1.0F);
  for (std::size_t r = 0; r < camera.layout->exposed_regions().size(); ++r) {
    const auto view = camera.flat_field.view(r);
    const Rectangle& area = view.area();
    for (int y = area.y0; y < area.y1(); ++y)
      for (int x = area.x0; x < area.x1(); ++x) view.at(x, y) = static_cast<float>(std::max(0.0, 1.0 + field.at(x, y)));
  }
}

void FlatField::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  multiply_values(state.expected.pixels(strip), context.camera.flat_field.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
