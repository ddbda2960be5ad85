#include <fmt/format.h>

#include "astroid/analysis/target_metrics.hpp"

namespace astroid {

const std::vector<FlagName>& flag_names() {
  static const std::vector<FlagName> names{
      {measurement_flag::kEdge, "edge", "the aperture is cut by the edge of the frame or window"},
      {measurement_flag::kSaturated, "saturated", "a pixel of the aperture is at full well or clipped by the ADC"},
      {measurement_flag::kBadPixel, "bad_pixel", "a pixel of the aperture is defective or not finite"},
      {measurement_flag::kContaminated, "contaminated", "neighbours give more than the configured share of the flux"},
      {measurement_flag::kNoBackground, "no_background", "too few background pixels: the fallback was used"},
      {measurement_flag::kOutside, "outside", "the star is not on the frame: no flux"},
      {measurement_flag::kNoFlux, "no_flux", "no pixel with light of the target: no flux"},
      {measurement_flag::kSpoiltBackground, "spoilt_background",
       "background pixels are saturated or bloomed on: the level is of the others"},
      {measurement_flag::kBlended, "blended", "PSF weights can't tell the star from its neighbours well"},
      {measurement_flag::kMerged, "merged", "stars that cannot be told apart are measured as one"},
      {measurement_flag::kUnsettled, "unsettled", "the fit did not converge, or ran away"},
      {measurement_flag::kOutlier, "outlier", "pixels near the star were left out of the fit"},
  };
  return names;
}

std::string flag_text(std::uint32_t flags) {
  std::string text;
  const auto add = [&text](std::string_view name) {
    if (!text.empty()) text += '|';
    text += name;
  };
  for (const FlagName& flag : flag_names()) {
    if ((flags & flag.bit) != 0) add(flag.name);
    flags &= ~flag.bit;
  }
  constexpr unsigned kBits = 32;
  for (unsigned bit = 0; bit < kBits; ++bit) {
    if ((flags >> bit & 1U) != 0) add(fmt::format("bit{}", bit));
  }
  return text;
}

}  // namespace astroid
