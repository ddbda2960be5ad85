#include "effects/displacement_need.hpp"

#include <fmt/format.h>

namespace astroid {

EffectNeed displacement_need(const SceneSummary& scene, double displacement, std::string_view what) {
  if (!(displacement > 0.0)) return {false, fmt::format("{} does not move any star in the run", what), 0.0, 0.0};
  const double flux = scene.brightest_target_electrons;
  const double bias = scene.flux_change(displacement) * flux;
  const double tolerance = scene.flux_tolerance(flux);
  return {
      bias > tolerance,
      fmt::format("{} moves stars by up to {:.3g} px, which changes the flux of the brightest unsaturated target by "
                  "at most {:.3g} e-; its tolerance is {:.3g} e-",
                  what, displacement, bias, tolerance),
      bias, 0.0};
}

}  // namespace astroid
