// The background under a star of a single image, whichever way it is estimated.
#pragma once

#include <memory>
#include <vector>

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
  struct Row {
    std::vector<double> level, rms;
  };
  [[nodiscard]] const Row& row(int y);

  std::shared_ptr<const BackgroundMap> mesh_;
  std::vector<Row> rows_;  // of the mesh, made when a star is on them
};

}  // namespace astroid::detail
