#include "effect_table_builder.hpp"
#include "effects/aberration_effect.hpp"
#include "effects/adc.hpp"
#include "effects/bad_pixels.hpp"
#include "effects/bias.hpp"
#include "effects/bias_drift.hpp"
#include "effects/breathing.hpp"
#include "effects/brighter_fatter.hpp"
#include "effects/charge_injection.hpp"
#include "effects/cosmic_rays.hpp"
#include "effects/cross_talk.hpp"
#include "effects/cti.hpp"
#include "effects/dark_current.hpp"
#include "effects/drift.hpp"
#include "effects/flat_field.hpp"
#include "effects/full_well.hpp"
#include "effects/gain.hpp"
#include "effects/ghosts.hpp"
#include "effects/intra_pixel_response.hpp"
#include "effects/jitter_file.hpp"
#include "effects/jitter_model.hpp"
#include "effects/nonlinearity.hpp"
#include "effects/photon_noise.hpp"
#include "effects/pick_up_noise.hpp"
#include "effects/prnu.hpp"
#include "effects/proper_motion_effect.hpp"
#include "effects/readout_noise.hpp"
#include "effects/repointing.hpp"
#include "effects/sky.hpp"
#include "effects/smearing.hpp"
#include "effects/stars.hpp"
#include "effects/stray_light.hpp"
#include "effects/sub_pixel_stars.hpp"
#include "effects/throughput.hpp"
#include "effects/variable_stars.hpp"
#include "effects/vignetting.hpp"
#include "effects/zodiacal_sky.hpp"

namespace astroid {

namespace {

using CcdTable =
    EffectTable<ProperMotionEffect,                                                                    // Catalogue
                JitterModelEffect, JitterFileEffect, DriftEffect, RepointingEffect, AberrationEffect,  // Pointing
                ThroughputEffect, Breathing, Stars, SubPixelStars, VariableStars, Ghosts,              // Optics
                Sky, ZodiacalSky, StrayLight,                                                          // Sky
                IntraPixelResponse,                                                                    // SubPixel
                Vignetting, FlatField, Prnu, DeadPixels, DarkCurrent, HotPixels, ChargeInjection, OpenShutterSmearing,
                FrameTransferSmearing,                                   // PixelMean
                PhotonNoise, CosmicRays, BrighterFatter, FullWell, Cti,  // PixelSample
                ReadoutNoise, GainEffect, CrossTalk, NonLinearity, BiasEffect, BiasDrift, RowOffset, PickUpNoise,
                BadPixelMap, Adc>;  // Readout

}  // namespace

const std::vector<std::unique_ptr<const Effect>>& effect_table(DetectorType type) {
  if (type == DetectorType::kCmos) return cmos_effect_table();
  static const std::vector<std::unique_ptr<const Effect>> ccd = CcdTable::make();
  return ccd;
}

}  // namespace astroid
