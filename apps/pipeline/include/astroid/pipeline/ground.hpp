// What the ground believes, and the estimators it builds from that.
#pragma once

#include <memory>
#include <vector>

#include "astroid/photometry/calibration.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// The believed field of a scene; owns what GroundModel points to.
struct Ground {
  std::vector<FieldStar> stars;
  std::shared_ptr<const PixelPsf> psf;
  GroundModel model;
};

/// A ground that knows the stars, the PSF, the mean background, the detector and the statistics of the jitter exactly.
/// @param scene  must outlive the result.
Ground perfect_ground(const Scene& scene);

/// The PSF that stars of a scene have in its images. @param scene  must outlive the result.
std::shared_ptr<const PixelPsf> psf_in_images(const Scene& scene);
/// What the ground believes of the readout, and what it corrects.
CalibrationModel calibration_model(const Mission& mission);

}  // namespace astroid
