#include "configuration_parameter.hpp"
#include "configuration_passbands.hpp"

namespace astroid::configuration {

std::vector<Parameter> telescope_parameters() {
  return {
      {.path = "Telescope/ZeroPoint",
       .unit = "mag",
       .range = from_to(0, 40),
       .fallback = "20.62",
       .meaning = "Magnitude of a star that gives one detected electron per second in one camera.",
       .example = "20.62",
       .assign = [](Mission& m, const Value& v) { m.telescope.zero_point = Magnitude(v.real); }},
      {.path = "Telescope/ZeroPoint/passband",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "P",
       .choices = {kPassbands.begin(), kPassbands.end()},
       .meaning = "Passband of the zero point; the catalogue's magnitudes are converted to it.",
       .example = "P",
       .assign = [](Mission& m, const Value& v) { m.telescope.zero_point_passband = v.text; }},
      {.path = "Telescope/Cameras",
       .kind = Kind::kInteger,
       .range = from_to(1, 1000),
       .fallback = "24",
       .meaning = "Number of cameras that observe the field.",
       .example = "24",
       .assign = [](Mission& m, const Value& v) { m.telescope.cameras = static_cast<int>(v.integer); }},
      {.path = "Telescope/SimulatedCameras",
       .kind = Kind::kInteger,
       .range = from_to(1, 1000),
       .fallback = "1",
       .meaning = "Number of cameras that are simulated, at most Cameras; noise that cameras do not share is scaled to "
                  "all of them.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.telescope.simulated_cameras = static_cast<int>(v.integer); }},
  };
}

}  // namespace astroid::configuration
