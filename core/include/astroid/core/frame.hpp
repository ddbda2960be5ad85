// Where simulation and photometry meet: one exposure as a detector delivers it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "astroid/core/image.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// What can be wrong with one pixel; bits of Frame::flags.
namespace pixel_flag {
inline constexpr std::uint8_t kFullWell = 1;      ///< charge reached the full well, or blooming passed through
inline constexpr std::uint8_t kAdcSaturated = 2;  ///< the ADC clipped
inline constexpr std::uint8_t kBad = 4;           ///< defective, masked or not finite
inline constexpr std::uint8_t kShortRamp = 8;     ///< fitted to the reads before it saturated: noisier, not wrong
inline constexpr std::uint8_t kCosmicRay = 16;    ///< a particle left charge here
/// What only the simulation knows: photometry takes no notice of these.
inline constexpr unsigned kTruth = kCosmicRay;
}  // namespace pixel_flag

/// What a FITS header says of an exposure.
struct FrameHeader {
  int camera = 0;
  std::int64_t exposure = 0;
  Seconds mid_time;      ///< of the exposure, since the start of the run
  double mid_mjd = 0.0;  ///< the same, TDB
  Seconds exposure_time{1.0};
  Gain gain{1.0};
  Electrons readout_noise;
  Adu bias;
  Adu saturation{65535.0};  ///< a pixel at or above it is saturated
};

/// One exposure: pixel values in ADU over a layout, and what is wrong with which pixel.
struct Frame {
  FrameHeader header;
  Plane<float, unit::Adu> pixels;          ///< 16-bit counts are exact in a float
  Plane<std::uint8_t, unit::Flags> flags;  ///< pixel_flag bits
};

}  // namespace astroid
