// What is computed of the fluxes, and what is kept.
#pragma once

#include <cstdint>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

enum class ImageOutput { kNone, kFirst, kEvery, kAll };
enum class LightCurveOutput { kNone, kTargets, kAll };

struct AnalysisSettings {
  Seconds bin{3600.0};               ///< duration to which noise is averaged
  double uncontaminated_spr = 1e-3;  ///< stars with less contamination judge magnitude recovery

  friend bool operator==(const AnalysisSettings&, const AnalysisSettings&) = default;
};

struct OutputSettings {
  ImageOutput images = ImageOutput::kFirst;
  int images_every = 1;
  LightCurveOutput light_curves = LightCurveOutput::kTargets;
  std::vector<std::int64_t> dump_steps;  ///< exposures whose intermediate maps are written

  friend bool operator==(const OutputSettings&, const OutputSettings&) = default;
};

}  // namespace astroid
