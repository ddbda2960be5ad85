#include "configuration_parameter.hpp"

namespace astroid::configuration {

std::vector<Parameter> sky_parameters() {
  constexpr double kPercentInOne = 100.0;  // a percentage as a fraction
  return {
      {.path = "StellarField/ProperMotion",
       .kind = Kind::kBoolean,
       .fallback = "on",
       .meaning = "Whether stars with proper motions are moved to the middle of the run.",
       .example = "on",
       .assign = [](Mission& m, const Value& v) { m.field.proper_motion = v.flag; }},
      {.path = "StellarField/Epoch",
       .unit = "yr",
       .range = from_to(1800, 2200),
       .fallback = "2000",
       .meaning = "Julian year of the catalogue's positions, where it has proper motions but no column ref_epoch.",
       .example = "2016",
       .assign = [](Mission& m, const Value& v) { m.field.catalogue_epoch = v.real; }},
      {.path = "StellarField/Variables",
       .kind = Kind::kFile,
       .meaning = "CSV file of variable stars: id, kind (sinusoid, transit, eclipse, lightcurve) and its numbers.",
       .example = "variables.csv",
       .assign = [](Mission& m, const Value& v) { m.field.variables = v.text; }},
      {.path = "StellarField/SkyModel",
       .kind = Kind::kChoice,
       .fallback = "constant",
       .choices = {"constant", "zodiacal"},
       .meaning =
           "Where the sky comes from: the number SkyBackground, or the zodiacal light in the direction and season "
           "of the run with UnresolvedStars on top.",
       .example = "zodiacal",
       .assign = [](Mission& m,
                    const Value& v) { m.field.sky = v.choice == 0 ? SkyModel::kConstant : SkyModel::kZodiacal; }},
      {.path = "StellarField/UnresolvedStars",
       .unit = "S10",
       .range = from_to(0, 1e6),
       .fallback = "model",
       .keyword = "model",
       .meaning = "Light of stars that are not in the catalogue, in stars of V = 10 per square degree (zodiacal sky); "
                  "model: by galactic latitude and longitude, of stars too faint for surveys.",
       .example = "30",
       .assign = [](Mission& m, const Value& v) { m.field.unresolved_stars = v.is_keyword ? -1.0 : v.real; }},
      {.path = "StellarField/StrayLight/Level",
       .unit = "e-/px/s",
       .range = from_to(0, 1e7),
       .fallback = "0",
       .meaning = "Stray light in detected electrons per pixel and second at the centre of the detector.",
       .example = "64",
       .assign = [](Mission& m, const Value& v) { m.field.stray_light.level = ElectronsPerSecond(v.real); }},
      {.path = "StellarField/StrayLight/GradientX",
       .unit = "%",
       .range = from_to(-100, 100),
       .fallback = "0",
       .meaning = "Change of the stray light from the centre of the detector to its right edge, relative to Level.",
       .example = "10",
       .assign = [](Mission& m, const Value& v) { m.field.stray_light.gradient_x = v.real / kPercentInOne; }},
      {.path = "StellarField/StrayLight/GradientY",
       .unit = "%",
       .range = from_to(-100, 100),
       .fallback = "0",
       .meaning = "Change of the stray light from the centre of the detector to its upper edge, relative to Level.",
       .example = "-5",
       .assign = [](Mission& m, const Value& v) { m.field.stray_light.gradient_y = v.real / kPercentInOne; }},
  };
}

}  // namespace astroid::configuration
