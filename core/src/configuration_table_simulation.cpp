#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {
constexpr double kMostQuarters = 1000;
}  // namespace

std::vector<Parameter> simulation_parameters() {
  return {
      {.path = "Simulation/Type",
       .kind = Kind::kChoice,
       .fallback = "CCD",
       .choices = {"CCD", "CMOS"},
       .meaning = "Kind of detector, which decides the order of the read-out effects.",
       .example = "CCD",
       .assign = [](Mission& m,
                    const Value& v) { m.simulation.type = v.choice == 0 ? DetectorType::kCcd : DetectorType::kCmos; }},
      {.path = "Simulation/Seed",
       .kind = Kind::kInteger,
       .range = at_least(0),
       .fallback = "1",
       .meaning = "Number from which every random draw follows: the same seed gives the same images.",
       .example = "42",
       .assign = [](Mission& m, const Value& v) { m.simulation.seed = static_cast<std::uint64_t>(v.integer); }},
      {.path = "Simulation/Accuracy",
       .unit = "ppm",
       .range = from_to(0.001, 1e5),
       .fallback = "1",
       .meaning = "Systematic error that all approximations together may add to the aperture flux of a star.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.simulation.accuracy = Ppm(v.real); }},
      {.path = "Simulation/Exposures",
       .kind = Kind::kInteger,
       .range = from_to(1, 1e9),
       .fallback = "1",
       .meaning = "Number of exposures.",
       .example = "576",
       .assign = [](Mission& m, const Value& v) { m.simulation.exposures = v.integer; }},
      {.path = "Simulation/Cycle",
       .unit = "s",
       .range = above_up_to(0, 1e6),
       .fallback = "25",
       .meaning = "Time from the start of one exposure to the start of the next.",
       .example = "25",
       .assign = [](Mission& m, const Value& v) { m.simulation.cycle = Seconds(v.real); }},
      {.path = "Simulation/ExposureTime",
       .unit = "s",
       .range = above_up_to(0, 1e6),
       .fallback = "21",
       .meaning = "Time during which an exposure collects light, at most the cycle.",
       .example = "21",
       .assign = [](Mission& m, const Value& v) { m.simulation.exposure_time = Seconds(v.real); }},
      {.path = "Simulation/Start",
       .kind = Kind::kTime,
       .fallback = "2027-01-01T00:00:00",
       .meaning = "Start of the first exposure, TDB.",
       .example = "2027-01-01T00:00:00",
       .assign =
           [](Mission& m, const Value& v) {
             m.simulation.start = v.text;
             m.simulation.start_mjd = v.real;
           }},
      {.path = "Simulation/Quarter",
       .kind = Kind::kInteger,
       .range = from_to(0, kMostQuarters),
       .fallback = "0",
       .meaning = "Quarter of the mission that is simulated, from 0: the run begins so many times Satellite/Quarter "
                  "after Start, turned by as many Satellite/Repointing/Turn.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.simulation.quarter = static_cast<int>(v.integer); }},
  };
}

}  // namespace astroid::configuration
