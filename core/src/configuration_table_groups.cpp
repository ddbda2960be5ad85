#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> group_parameters() {
  return {
      {.path = "Telescope/Groups/Cameras",
       .kind = Kind::kIntegerList,
       .range = from_to(1, 1000),
       .meaning = "Cameras of each group; none: all cameras are alike. Their sum is Telescope/Cameras, and "
                  "SimulatedCameras holds the same share of each.",
       .example = "6 6 6 6",
       .assign =
           [](Mission& m, const Value& v) {
             m.telescope.groups.cameras.clear();
             for (const std::int64_t n : v.integers) m.telescope.groups.cameras.push_back(static_cast<int>(n));
           }},
      {.path = "Telescope/Groups/Tilt",
       .kind = Kind::kRealList,
       .unit = "deg",
       .range = from_to(0, 60),
       .meaning = "Angle from the spacecraft's pointing to the optical axis of each group; none: 0.",
       .example = "9.2 9.2 9.2 9.2",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.tilt = v.reals; }},
      {.path = "Telescope/Groups/Azimuth",
       .kind = Kind::kRealList,
       .unit = "deg",
       .range = from_to(-360, 360),
       .meaning = "Direction of the tilt, from +x to +y of a camera that looks where the spacecraft points; none: 0.",
       .example = "45 135 225 315",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.azimuth = v.reals; }},
      {.path = "Telescope/Groups/Roll",
       .kind = Kind::kRealList,
       .unit = "deg",
       .range = from_to(-360, 360),
       .meaning =
           "Rotation of each group's detector about its own optical axis, in the sense of Satellite/Pointing/Roll "
           "and beyond it; none: 0.",
       .example = "0 0 0 0",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.roll = v.reals; }},
      {.path = "Telescope/Groups/Stagger",
       .kind = Kind::kRealList,
       .unit = "s",
       .range = from_to(0, 1e6),
       .meaning = "Time by which each group's exposures begin after those of an unstaggered camera, less than a cycle; "
                  "none: 0.",
       .example = "0 6.25 12.5 18.75",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.stagger = v.reals; }},
      {.path = "Telescope/Groups/OffsetX",
       .kind = Kind::kRealList,
       .unit = "px",
       .range = from_to(-1e7, 1e7),
       .meaning =
           "What each group adds to the column CCD/OpticalAxis/X where its axis falls: its detector, and its pixel "
           "phase; none: 0.",
       .example = "0.1 0.35 0.6 0.85",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.offset_x = v.reals; }},
      {.path = "Telescope/Groups/OffsetY",
       .kind = Kind::kRealList,
       .unit = "px",
       .range = from_to(-1e7, 1e7),
       .meaning = "The same of the row CCD/OpticalAxis/Y.",
       .example = "0.3 0.8 0.05 0.55",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.offset_y = v.reals; }},
      {.path = "Telescope/Groups/Throughput",
       .kind = Kind::kRealList,
       .range = above_up_to(0, 1),
       .meaning = "Light that each group passes at the beginning of life, relative to Telescope/Throughput; none: 1.",
       .example = "1 0.99 1 0.98",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.throughput = v.reals; }},
      {.path = "Telescope/Groups/EndOfLife",
       .kind = Kind::kRealList,
       .range = above_up_to(0, 1),
       .meaning = "Throughput of each group at the end of life relative to its beginning; none: that of "
                  "Telescope/Ageing/EndOfLife.",
       .example = "0.98 0.97 0.98 0.95",
       .assign = [](Mission& m, const Value& v) { m.telescope.groups.end_of_life = v.reals; }},
  };
}

}  // namespace astroid::configuration
