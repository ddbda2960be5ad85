#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr Range kAngle = from_to(0, 3600);     // arcsec
constexpr Range kRate = from_to(-3600, 3600);  // arcsec per day

}  // namespace

std::vector<Parameter> motion_parameters() {
  return {
      {.path = "Satellite/Drift/Yaw",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Thermo-elastic drift of the yaw angle: it starts each quarter at 0, follows a polynomial of second "
                  "order drawn for it, and stays below this.",
       .example = "12",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.yaw = Arcseconds(v.real); }},
      {.path = "Satellite/Drift/Pitch",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Thermo-elastic drift of the pitch angle: it starts each quarter at 0, follows a polynomial of "
                  "second order drawn for it, and stays below this.",
       .example = "12",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.pitch = Arcseconds(v.real); }},
      {.path = "Satellite/Drift/Roll",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Thermo-elastic drift of the roll angle: it starts each quarter at 0, follows a polynomial of second "
                  "order drawn for it, and stays below this.",
       .example = "12",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.roll = Arcseconds(v.real); }},
      {.path = "Satellite/Drift/YawRate",
       .unit = "arcsec/d",
       .range = kRate,
       .fallback = "0",
       .meaning = "Linear drift of the yaw angle, from 0 at the start of each quarter.",
       .example = "0.2",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.yaw_rate = Arcseconds(v.real); }},
      {.path = "Satellite/Drift/PitchRate",
       .unit = "arcsec/d",
       .range = kRate,
       .fallback = "0",
       .meaning = "Linear drift of the pitch angle, from 0 at the start of each quarter.",
       .example = "0.2",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.pitch_rate = Arcseconds(v.real); }},
      {.path = "Satellite/Drift/RollRate",
       .unit = "arcsec/d",
       .range = kRate,
       .fallback = "0",
       .meaning = "Linear drift of the roll angle, from 0 at the start of each quarter.",
       .example = "0.2",
       .assign = [](Mission& m, const Value& v) { m.satellite.drift.roll_rate = Arcseconds(v.real); }},
      {.path = "Satellite/Repointing/Yaw",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Rms error of the yaw angle with which each quarter but the first is pointed.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.satellite.repointing.yaw = Arcseconds(v.real); }},
      {.path = "Satellite/Repointing/Pitch",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Rms error of the pitch angle with which each quarter but the first is pointed.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.satellite.repointing.pitch = Arcseconds(v.real); }},
      {.path = "Satellite/Repointing/Roll",
       .unit = "arcsec",
       .range = kAngle,
       .fallback = "0",
       .meaning = "Rms error of the roll angle with which each quarter but the first is pointed.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.satellite.repointing.roll = Arcseconds(v.real); }},
      {.path = "Satellite/Repointing/Turn",
       .unit = "deg",
       .range = from_to(-360, 360),
       .fallback = "0",
       .meaning = "Rotation about the optical axis between a quarter and the next, which puts every star on another "
                  "place of the detector: a run is then of one quarter (Simulation/Quarter).",
       .example = "90",
       .assign = [](Mission& m, const Value& v) { m.satellite.repointing.turn = Degrees(v.real); }},
      {.path = "Satellite/Quarter",
       .unit = "d",
       .range = from_to(0, 10000),
       .fallback = "90",
       .meaning = "Time after which the spacecraft is pointed anew, so that drift begins anew; 0: never.",
       .example = "90",
       .assign = [](Mission& m, const Value& v) { m.satellite.quarter_days = v.real; }},
      {.path = "Satellite/Aberration",
       .kind = Kind::kBoolean,
       .fallback = "off",
       .meaning =
           "Whether stars move by the kinematic aberration of a spacecraft at the second Lagrange point, relative to "
           "the boresight and to the start of the run.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.satellite.aberration = v.flag; }},
  };
}

}  // namespace astroid::configuration
