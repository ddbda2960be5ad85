// Bad pixels that are known by their place: a list or a mask in a file.
#pragma once

#include <string>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/mission.hpp"

namespace astroid {

struct HotPixel {
  int x = 0, y = 0;
  ElectronsPerSecond current;
};
struct DeadPixel {
  int x = 0, y = 0;
};

struct BadPixelList {
  std::vector<DeadPixel> dead;
  std::vector<HotPixel> hot;
};

/// Reads CCD/BadPixels/File: a table with columns x and y (0-based pixels of the detector) and perhaps kind and
/// rate_e_per_s, or a FITS image of the whole detector with 0 good, 1 dead, 2 hot.
///
/// Kinds are dead (if none is given), hot, with the rate of the table or CCD/BadPixels/HotCurrent, and column: the
/// pixel and all behind it on the way to the register see no light; of a CMOS detector the whole column.
/// @throws InputError with every line that is wrong: a place beside the detector, an unknown kind, a rate below 0;
///         EnvironmentError when the file cannot be read.
BadPixelList read_bad_pixels(const Mission& mission);

}  // namespace astroid
