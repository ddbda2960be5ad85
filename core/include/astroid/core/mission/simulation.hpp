// How long, how accurately, and from which seed.
#pragma once

#include <cstdint>
#include <string>

#include "astroid/core/units.hpp"

namespace astroid {

enum class DetectorType { kCcd, kCmos };
enum class Renderer { kAuto, kAnalytic, kPrf, kSubPixel };

struct SimulationSettings {
  DetectorType type = DetectorType::kCcd;
  std::uint64_t seed = 1;
  Ppm accuracy{1.0};
  std::int64_t exposures = 1;
  Seconds cycle{25.0};
  Seconds exposure_time{21.0};
  Seconds stagger{0.0};  ///< from the start of a cycle to that of its exposure; of a camera group, by group_mission()
  std::string start = "2027-01-01T00:00:00";  ///< TDB, ISO 8601
  double start_mjd = 61406.0;                 ///< the same of `quarter` as MJD (TDB), filled by the reader
  int quarter = 0;                            ///< of the mission that the run belongs to; `start` is that of quarter 0
  Renderer renderer = Renderer::kAuto;
  int sub_pixels = 0;  ///< per pixel and axis, of the sub-pixel renderer; 0: from the accuracy

  friend bool operator==(const SimulationSettings&, const SimulationSettings&) = default;
};

}  // namespace astroid
