#include "effects/charge_injection.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/need.hpp"

namespace astroid {

EffectNeed ChargeInjection::is_needed(const SceneSummary& scene) const {
  const ChargeInjectionSettings& injection = scene.mission->ccd.charge_injection;
  if (injection.every_rows <= 0) return {false, "no charge is injected (EveryRows 0)", 0.0, 0.0};
  if (injection.first_row >= scene.mission->ccd.rows) return {false, "the first injected row does not exist", 0.0, 0.0};
  // A star may lie on such a row.
  return background_need(scene, injection.level.value(),
                         fmt::format("charge injected into every {}th row", injection.every_rows));
}

void ChargeInjection::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const ChargeInjectionSettings& injection = context.scene.mission().ccd.charge_injection;
  if (injection.every_rows <= 0) return;
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const auto view = state.expected.view(strip, a);
    for (int y = view.area().y0; y < view.area().y1(); ++y)
      if (y >= injection.first_row && (y - injection.first_row) % injection.every_rows == 0)
        add_constant(view.row(y), injection.level.value());
  }
}

}  // namespace astroid
