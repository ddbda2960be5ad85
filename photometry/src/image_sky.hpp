// The background under a star of a single image, whichever way it is estimated.
#pragma once

#include <optional>

#include "astroid/photometry/background.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid::detail {

/// In ADU; level is NaN where nothing could be estimated.
struct SkyUnderStar {
  double level = 0.0;
  double error = 0.0;     ///< of the level
  double variance = 0.0;  ///< of one pixel without stars, e-²
  bool fallback = false;  ///< the median of the mesh stands in
};

class ImageSky {
 public:
  ImageSky(const Frame& frame, const ImagePhotometrySettings& settings);
  [[nodiscard]] SkyUnderStar under(PixelPosition star);

 private:
  [[nodiscard]] const BackgroundMap& mesh();
  [[nodiscard]] SkyUnderStar from_rms(double level, double error, double rms) const;

  const Frame& frame_;
  const ImagePhotometrySettings& settings_;
  std::optional<BackgroundMap> mesh_;
  Image<double, unit::Adu> mesh_level_;  // filled when the mesh is the method
  Image<double, unit::Adu> mesh_rms_;
};

}  // namespace astroid::detail
