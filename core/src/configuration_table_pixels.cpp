// What happens to the charge of a CCD between its pixels: flat field, injection, particles, brighter-fatter, transfer.
#include <utility>

#include "configuration_parameter.hpp"

namespace astroid::configuration {

namespace {

constexpr double kPercentInOne = 100.0;
constexpr double kMostRows = 100000;

std::vector<Parameter> pattern_parameters() {
  return {
      {.path = "CCD/FlatField/RMS",
       .unit = "%",
       .range = from_to(0, 50),
       .fallback = "0",
       .meaning = "Rms over the detector of the large-scale pattern of sensitivity; 0: none.",
       .example = "0.5",
       .assign = [](Mission& m, const Value& v) { m.ccd.flat_field.rms = v.real / kPercentInOne; }},
      {.path = "CCD/FlatField/Exponent",
       .range = from_to(0, 4),
       .fallback = "1",
       .meaning = "Exponent of the power spectrum of that pattern, frequency^-exponent: 0 is white, 1 is 1/f.",
       .example = "1",
       .assign = [](Mission& m, const Value& v) { m.ccd.flat_field.exponent = v.real; }},
      {.path = "CCD/ChargeInjection/EveryRows",
       .kind = Kind::kInteger,
       .range = from_to(0, kMostRows),
       .fallback = "0",
       .meaning = "Rows from one line of injected charge to the next; 0: none.",
       .example = "100",
       .assign = [](Mission& m, const Value& v) { m.ccd.charge_injection.every_rows = static_cast<int>(v.integer); }},
      {.path = "CCD/ChargeInjection/FirstRow",
       .kind = Kind::kInteger,
       .range = from_to(0, kMostRows),
       .fallback = "0",
       .meaning = "First row that charge is injected into.",
       .example = "50",
       .assign = [](Mission& m, const Value& v) { m.ccd.charge_injection.first_row = static_cast<int>(v.integer); }},
      {.path = "CCD/ChargeInjection/Level",
       .unit = "e-",
       .range = from_to(0, 1e9),
       .fallback = "0",
       .meaning = "Mean charge injected into each pixel of such a row; it has Poisson noise.",
       .example = "50000",
       .assign = [](Mission& m, const Value& v) { m.ccd.charge_injection.level = Electrons(v.real); }},
  };
}

std::vector<Parameter> cosmic_ray_parameters() {
  return {
      {.path = "CCD/CosmicRays/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "trail",
       .choices = {"trail", "slab"},
       .meaning = "Charge and length of a hit: independent of each other with the distributions given, or those of "
                  "particles from all directions through a slab of silicon.",
       .example = "trail",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr CosmicRayKind kModels[] = {CosmicRayKind::kTrail, CosmicRayKind::kSlab};
             m.ccd.cosmic_rays.model = kModels[v.choice];
           }},
      {.path = "CCD/CosmicRays/Rate",
       .unit = "1/cm2/s",
       .range = from_to(0, 1e4),
       .fallback = "0",
       .meaning = "Mean number of particles that hit the detector; 0: none.",
       .example = "10",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.rate = v.real; }},
      {.path = "CCD/CosmicRays/LongestTrack",
       .unit = "px",
       .range = from_to(0, 500),
       .fallback = "15",
       .meaning = "Longest track on the detector. Lengths of trails are uniform up to it; of a slab longer tracks are "
                  "left out.",
       .example = "15",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.longest_track = Pixels(v.real); }},
      {.path = "CCD/CosmicRays/ChargeLocation",
       .unit = "e-",
       .range = from_to(0, 1e7),
       .fallback = "2500",
       .meaning = "Location of the skew-normal distribution of a trail's charge.",
       .example = "2500",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.charge_location = Electrons(v.real); }},
      {.path = "CCD/CosmicRays/ChargeScale",
       .unit = "e-",
       .range = from_to(0, 1e7),
       .fallback = "2000",
       .meaning = "Scale of the skew-normal distribution of a trail's charge.",
       .example = "2000",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.charge_scale = Electrons(v.real); }},
      {.path = "CCD/CosmicRays/ChargeShape",
       .range = from_to(-1000, 1000),
       .fallback = "30",
       .meaning = "Shape of that distribution: 0 is normal, positive has a tail to large charges.",
       .example = "30",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.charge_shape = v.real; }},
      {.path = "CCD/CosmicRays/Thickness",
       .unit = "um",
       .range = from_to(0.1, 1000),
       .fallback = "16",
       .meaning = "Thickness of the slab.",
       .example = "16",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.thickness = v.real; }},
      {.path = "CCD/CosmicRays/PathCharge",
       .unit = "e-/um",
       .range = from_to(0, 1e5),
       .fallback = "80",
       .meaning = "Most probable charge that a particle leaves along its path through the slab.",
       .example = "80",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.path_charge = v.real; }},
      {.path = "CCD/CosmicRays/Fluctuation",
       .unit = "%",
       .range = from_to(0, 25),
       .fallback = "10",
       .meaning = "Width of the Moyal distribution of that charge, relative to it; the mean is 1.27 widths above the "
                  "most probable one.",
       .example = "10",
       .assign = [](Mission& m, const Value& v) { m.ccd.cosmic_rays.fluctuation = v.real / kPercentInOne; }},
  };
}

std::vector<Parameter> brighter_fatter_parameters() {
  constexpr Range kShift = from_to(0, 1e-5);
  return {
      {.path = "CCD/BrighterFatter/Serial",
       .unit = "px/e-",
       .range = kShift,
       .fallback = "0",
       .meaning = "Shift of the boundary between two columns by an electron in a pixel next to it; 0: none.",
       .example = "3e-07",
       .assign = [](Mission& m, const Value& v) { m.ccd.brighter_fatter.serial = v.real; }},
      {.path = "CCD/BrighterFatter/Parallel",
       .unit = "px/e-",
       .range = kShift,
       .fallback = "0",
       .meaning = "The same of the boundary between two rows.",
       .example = "4e-07",
       .assign = [](Mission& m, const Value& v) { m.ccd.brighter_fatter.parallel = v.real; }},
      {.path = "CCD/BrighterFatter/Decay",
       .unit = "1/px",
       .range = from_to(0.01, 10),
       .fallback = "0.5",
       .meaning = "How fast the shift falls with the distance from the charge.",
       .example = "0.5",
       .assign = [](Mission& m, const Value& v) { m.ccd.brighter_fatter.decay = v.real; }},
      {.path = "CCD/BrighterFatter/Range",
       .kind = Kind::kInteger,
       .unit = "px",
       .range = from_to(1, 16),
       .fallback = "4",
       .meaning = "Charge farther than this from a boundary does not shift it.",
       .example = "4",
       .assign = [](Mission& m, const Value& v) { m.ccd.brighter_fatter.range = static_cast<int>(v.integer); }},
  };
}

std::vector<Parameter> transfer_parameters() {
  constexpr Range kShare = from_to(0, 1);
  return {
      {.path = "CCD/CTI/model",
       .kind = Kind::kChoice,
       .is_attribute = true,
       .fallback = "none",
       .choices = {"none", "simple", "traps"},
       .meaning = "Charge-transfer inefficiency: none, the same share lost at every transfer, or traps that fill and "
                  "empty.",
       .example = "simple",
       .assign =
           [](Mission& m, const Value& v) {
             constexpr CtiModel kModels[] = {CtiModel::kNone, CtiModel::kSimple, CtiModel::kTraps};
             m.ccd.cti.model = kModels[v.choice];
           }},
      {.path = "CCD/CTI/Parallel",
       .range = kShare,
       .fallback = "0",
       .meaning = "Share of the charge that a transfer between rows leaves behind: 1 - CTE (simple model).",
       .example = "1e-06",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.parallel = v.real; }},
      {.path = "CCD/CTI/Serial",
       .range = kShare,
       .fallback = "0",
       .meaning = "The same for a transfer between columns in the register (simple model).",
       .example = "1e-06",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.serial = v.real; }},
      {.path = "CCD/CTI/Beta",
       .range = kShare,
       .fallback = "0.37",
       .meaning = "Exponent with which the volume of a packet grows with its charge (traps).",
       .example = "0.37",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.beta = v.real; }},
      {.path = "CCD/CTI/Temperature",
       .unit = "K",
       .range = from_to(1, 400),
       .fallback = "203",
       .meaning = "Temperature of the detector (traps).",
       .example = "203",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.temperature = v.real; }},
      {.path = "CCD/CTI/RowTime",
       .unit = "s",
       .range = above_up_to(0, 1e4),
       .fallback = "0.0007718",
       .meaning = "Time that charge stays in one row while the detector is read (traps).",
       .example = "0.0007718",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.row_time = Seconds(v.real); }},
      {.path = "CCD/CTI/ColumnTime",
       .unit = "s",
       .range = above_up_to(0, 1e4),
       .fallback = "3.4e-07",
       .meaning = "Time that charge stays in one element of the register (traps).",
       .example = "3.4e-07",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.column_time = Seconds(v.real); }},
      {.path = "CCD/CTI/TrapDensity",
       .kind = Kind::kRealList,
       .unit = "1/px",
       .range = from_to(0, 1e6),
       .meaning = "Traps per pixel of each species.",
       .example = "4.9 1.655 0.78 6.62",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.trap_density = v.reals; }},
      {.path = "CCD/CTI/RegisterDensity",
       .kind = Kind::kRealList,
       .unit = "1/px",
       .range = from_to(0, 1e6),
       .meaning = "Traps per element of the register of each species; unset: none.",
       .example = "4.9 1.655 0.78 6.62",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.register_density = v.reals; }},
      {.path = "CCD/CTI/CrossSection",
       .kind = Kind::kRealList,
       .unit = "m2",
       .range = from_to(0, 1),
       .meaning = "Cross-section of each species for the capture of an electron.",
       .example = "2.46e-20 1.74e-22 7.05e-23 2.45e-23",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.trap_cross_section = v.reals; }},
      {.path = "CCD/CTI/ReleaseTime",
       .kind = Kind::kRealList,
       .unit = "s",
       .range = above_up_to(0, 1e12),
       .meaning = "Mean time after which each species releases an electron.",
       .example = "0.000237 0.0243 0.00203 0.14",
       .assign = [](Mission& m, const Value& v) { m.ccd.cti.trap_release_time = v.reals; }},
  };
}

}  // namespace

std::vector<Parameter> pixel_effect_parameters() {
  std::vector<Parameter> all;
  for (auto part : {pattern_parameters, cosmic_ray_parameters, brighter_fatter_parameters, transfer_parameters})
    for (Parameter& parameter : part()) all.push_back(std::move(parameter));
  return all;
}

}  // namespace astroid::configuration
