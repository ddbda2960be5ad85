// What there is to see.
#pragma once

#include <string>

#include "astroid/core/units.hpp"

namespace astroid {

enum class SkyModel { kConstant, kZodiacal };

/// Light from outside the field.
struct StrayLightSettings {
  ElectronsPerSecond level{0.0};  ///< detected, per pixel, at the centre of the detector
  double gradient_x = 0.0;        ///< relative change from the centre to the right edge
  double gradient_y = 0.0;        ///< and to the upper edge; |x| + |y| <= 1, so that it is nowhere negative

  friend bool operator==(const StrayLightSettings&, const StrayLightSettings&) = default;
};

struct StellarFieldSettings {
  std::string catalogue;  ///< absolute path
  std::string catalogue_passband = "V";
  std::string catalogue_unit = "deg";  ///< of ra and dec: deg or rad
  double catalogue_epoch = 2000.0;     ///< Julian year of its positions, where it has proper motions but no epochs
  bool proper_motion = true;           ///< whether stars are moved to the middle of the run
  double assumed_bv = 0.6;             ///< colour B-V in the catalogue's system where the catalogue has none
  double assumed_teff = 5778.0;        ///< K, for V -> P where the catalogue has none
  Magnitude faint_limit{99.0};         ///< stars fainter than this are left out
  std::string background_catalogue;    ///< absolute path; optional second file, e.g. made by `astroid field`
  std::string variables;               ///< absolute path; optional file of variable stars
  SkyModel sky = SkyModel::kConstant;
  ElectronsPerSecond sky_background{0.0};  ///< per pixel, detected; of the constant model
  double unresolved_stars = -1.0;  ///< S10 of stars that are not in the catalogue (zodiacal model); < 0: by latitude
  StrayLightSettings stray_light;

  friend bool operator==(const StellarFieldSettings&, const StellarFieldSettings&) = default;
};

}  // namespace astroid
