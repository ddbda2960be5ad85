// What only a CMOS detector keeps: patterns of its pixels, and ramps between two reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/sim/persistence.hpp"
#include "astroid/sim/ramp_fit.hpp"
#include "astroid/sim/strip.hpp"
#include "astroid/sim/telegraph.hpp"

namespace astroid {

/// Fixed for a camera; a plane is empty where its effect is off.
struct CmosPatterns {
  Plane<float, unit::Relative> gain;                     ///< signal of a pixel per electron, mean 1
  Plane<float, unit::Relative> readout_noise;            ///< of a pixel relative to the detector's, root mean square 1
  Plane<float, unit::Adu> offset;                        ///< of a pixel, mean 0
  std::vector<TelegraphPixel> telegraph;                 ///< in the order of the layout
  std::vector<std::size_t> telegraph_at;                 ///< where each is in the buffer
  std::shared_ptr<const RampLadder> ladder;              ///< null where an exposure is read once
  std::shared_ptr<const PersistenceKernel> persistence;  ///< null where the effect is off
};

/// The ramps of one exposure.
struct RampPlanes {
  StripPlane<std::uint8_t, unit::Flags> level, used;
  StripPlane<float, unit::Adu> previous;
  StripPlane<double, unit::Adu> carried, numerator;

  RampPlanes() = default;
  RampPlanes(const std::shared_ptr<const PixelLayout>& layout, std::size_t longest_strip)
      : level(layout, longest_strip),
        used(layout, longest_strip),
        previous(layout, longest_strip),
        carried(layout, longest_strip),
        numerator(layout, longest_strip) {}
  void make_whole() {
    level.make_whole();
    used.make_whole();
    previous.make_whole();
    carried.make_whole();
    numerator.make_whole();
  }
  [[nodiscard]] RampPixels pixels(const Strip& strip) {
    return {.level = level.pixels(strip),
            .previous = previous.pixels(strip),
            .carried = carried.pixels(strip),
            .numerator = numerator.pixels(strip),
            .used = used.pixels(strip)};
  }
};

}  // namespace astroid
