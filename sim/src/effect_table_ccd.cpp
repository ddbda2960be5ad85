#include <array>

#include "astroid/sim/effect_table.hpp"
#include "effects/aberration_effect.hpp"
#include "effects/adc.hpp"
#include "effects/bad_pixels.hpp"
#include "effects/bias.hpp"
#include "effects/bias_drift.hpp"
#include "effects/cross_talk.hpp"
#include "effects/dark_current.hpp"
#include "effects/drift.hpp"
#include "effects/full_well.hpp"
#include "effects/gain.hpp"
#include "effects/jitter_file.hpp"
#include "effects/jitter_model.hpp"
#include "effects/nonlinearity.hpp"
#include "effects/photon_noise.hpp"
#include "effects/prnu.hpp"
#include "effects/proper_motion_effect.hpp"
#include "effects/readout_noise.hpp"
#include "effects/repointing.hpp"
#include "effects/sky.hpp"
#include "effects/smearing.hpp"
#include "effects/stars.hpp"
#include "effects/stray_light.hpp"
#include "effects/variable_stars.hpp"
#include "effects/zodiacal_sky.hpp"

namespace astroid {

namespace {

/// The order of the run is the order of this list.
template <class... Effects>
struct Table {
  static constexpr std::array<EffectSpec, sizeof...(Effects)> kSpecs{Effects::kSpec...};
  static_assert(is_consistent(kSpecs),
                "an effect reads a plane that nothing wrote, a stream number is used twice, or a level steps back");
  static std::vector<std::unique_ptr<const Effect>> make() {
    std::vector<std::unique_ptr<const Effect>> effects;
    (effects.push_back(std::make_unique<const Effects>()), ...);
    return effects;
  }
};

using CcdTable =
    Table<ProperMotionEffect,                                                                    // Catalogue
          JitterModelEffect, JitterFileEffect, DriftEffect, RepointingEffect, AberrationEffect,  // Pointing
          Stars, VariableStars,                                                                  // Optics
          Sky, ZodiacalSky, StrayLight,                                                          // Sky
          Prnu, DeadPixels, DarkCurrent, HotPixels, OpenShutterSmearing, FrameTransferSmearing,  // PixelMean
          PhotonNoise, FullWell,                                                                 // PixelSample
          ReadoutNoise, GainEffect, CrossTalk, NonLinearity, BiasEffect, BiasDrift, RowOffset, BadPixelMap,
          Adc>;  // Readout

}  // namespace

const std::vector<std::unique_ptr<const Effect>>& effect_table(DetectorType type) {
  if (type != DetectorType::kCcd)
    throw InputError(Problem{.parameter = "Simulation/Type",
                             .value = "CMOS",
                             .expected = "CCD",
                             .message = "only CCD detectors can be simulated"});
  static const std::vector<std::unique_ptr<const Effect>> ccd = CcdTable::make();
  return ccd;
}

}  // namespace astroid
