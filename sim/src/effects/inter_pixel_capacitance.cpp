#include "effects/inter_pixel_capacitance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/plane_kernels.hpp"
#include "astroid/sim/inter_pixel_capacitance.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

EffectNeed InterPixelCapacitance::is_needed(const SceneSummary& scene) const {
  const InterPixelCoupling coupling = pixel_coupling(scene.mission->cmos);
  const double leaving = 1.0 - coupling.own();
  if (!(leaving > 0.0)) return {false, "pixels are not coupled (inter-pixel capacitance 0)", 0.0, 0.0};
  // At most what leaves every pixel leaves an aperture; the share is the same for every star.
  const double bias = leaving * scene.brightest_target_electrons;
  const double allowed = scene.flux_tolerance(scene.brightest_target_electrons);
  return {
      bias > allowed,
      fmt::format("{:.3g} % of a pixel's signal appears in its neighbours: up to {:.4g} e- of the brightest target, "
                  "whose tolerance is {:.3g} e-",
                  100.0 * leaving, bias, allowed),
      bias, 2.0 * leaving};
}

void InterPixelCapacitance::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const InterPixelCoupling coupling = pixel_coupling(context.scene.mission().cmos);
  const double per_gain = 1.0 / context.scene.mission().ccd.gain.value();
  for (std::size_t area = 0; area < strip.areas.size(); ++area) {
    const Rectangle& rectangle = strip.areas[area];
    state.scratch.resize(rectangle.size());
    const ImageView<double, unit::SampledElectrons> signal(state.scratch.data(), rectangle,
                                                           static_cast<std::size_t>(rectangle.nx));
    couple_pixels(state.sampled.view(strip, area), coupling, signal);
    const auto analog = state.analog.view(strip, area);
    scale_values(state.scratch, per_gain, {analog.data(), rectangle.size()});
  }
}

}  // namespace astroid
