#include "astroid/sim/effect.hpp"

namespace astroid {

std::string_view to_string(EffectLevel level) {
  switch (level) {
    case EffectLevel::kCatalogue:
      return "Catalogue";
    case EffectLevel::kPointing:
      return "Pointing";
    case EffectLevel::kOptics:
      return "Optics";
    case EffectLevel::kSky:
      return "Sky";
    case EffectLevel::kSubPixel:
      return "SubPixel";
    case EffectLevel::kPixelMean:
      return "PixelMean";
    case EffectLevel::kPixelSample:
      return "PixelSample";
    case EffectLevel::kReadout:
      return "Readout";
  }
  return "?";
}

void Effect::prepare(CameraState& /*camera*/, const PrepareContext& /*context*/) const {}

}  // namespace astroid
