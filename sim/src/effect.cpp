#include "astroid/sim/effect.hpp"

#include "astroid/sim/scene.hpp"

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

void Effect::set_conditions(const Scene& /*scene*/, Seconds /*time*/, Conditions& /*conditions*/) const {}

void Effect::prepare(CameraState& /*camera*/, const PrepareContext& /*context*/) const {}

void Effect::support(const Scene& scene, std::vector<Rectangle>& regions) const {
  const int halo = spec().halo_px;
  if (halo == 0) return;
  const Rectangle detector = scene.detector();
  for (Rectangle& r : regions)
    r = halo == kWholeColumn ? Rectangle{r.x0, detector.y0, r.nx, detector.ny}
                             : intersect(detector, {r.x0 - halo, r.y0 - halo, r.nx + 2 * halo, r.ny + 2 * halo});
}

}  // namespace astroid
