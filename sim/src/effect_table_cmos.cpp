#include "effect_table_builder.hpp"
#include "effects/aberration_effect.hpp"
#include "effects/adc.hpp"
#include "effects/bad_pixels.hpp"
#include "effects/bias.hpp"
#include "effects/breathing.hpp"
#include "effects/column_noise.hpp"
#include "effects/cosmic_rays.hpp"
#include "effects/dark_current.hpp"
#include "effects/drift.hpp"
#include "effects/flat_field.hpp"
#include "effects/gain.hpp"
#include "effects/ghosts.hpp"
#include "effects/inter_pixel_capacitance.hpp"
#include "effects/intra_pixel_response.hpp"
#include "effects/jitter_file.hpp"
#include "effects/jitter_model.hpp"
#include "effects/persistence.hpp"
#include "effects/photon_noise.hpp"
#include "effects/pixel_gain.hpp"
#include "effects/pixel_offset.hpp"
#include "effects/pixel_readout_noise.hpp"
#include "effects/pixel_saturation.hpp"
#include "effects/prnu.hpp"
#include "effects/proper_motion_effect.hpp"
#include "effects/ramp_fit.hpp"
#include "effects/ramp_reads.hpp"
#include "effects/repointing.hpp"
#include "effects/reset_noise.hpp"
#include "effects/rolling_shutter.hpp"
#include "effects/sky.hpp"
#include "effects/stars.hpp"
#include "effects/stray_light.hpp"
#include "effects/sub_pixel_stars.hpp"
#include "effects/telegraph_pixels.hpp"
#include "effects/throughput.hpp"
#include "effects/variable_stars.hpp"
#include "effects/vignetting.hpp"
#include "effects/zodiacal_sky.hpp"

namespace astroid {

namespace {

// From PhotonNoise to RampReads: once for every read.
using CmosTable = EffectTable<ProperMotionEffect,  // Catalogue
                              JitterModelEffect, JitterFileEffect, DriftEffect, RepointingEffect, RollingShutter,
                              AberrationEffect,                                                          // Pointing
                              ThroughputEffect, Breathing, Stars, SubPixelStars, VariableStars, Ghosts,  // Optics
                              Sky, ZodiacalSky, StrayLight,                                              // Sky
                              IntraPixelResponse,                                                        // SubPixel
                              Vignetting, FlatField, Prnu, DeadPixels, DarkCurrent, HotPixels, TelegraphPixels,
                              Persistence,                               // PixelMean
                              PhotonNoise, CosmicRays, PixelSaturation,  // PixelSample
                              GainEffect, InterPixelCapacitance, PixelGain, ResetNoise, PixelReadoutNoise, ColumnNoise,
                              BiasEffect, PixelOffset, Adc, RampReads, RampFitEffect, BadPixelMap>;  // Readout

}  // namespace

const std::vector<std::unique_ptr<const Effect>>& cmos_effect_table() {
  static const std::vector<std::unique_ptr<const Effect>> cmos = CmosTable::make();
  return cmos;
}

}  // namespace astroid
