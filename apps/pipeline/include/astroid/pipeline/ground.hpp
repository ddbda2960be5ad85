// What the ground believes, and the estimators it builds from that.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "astroid/photometry/calibration.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/attitude_correction.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/run.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// The believed field of a scene; owns what GroundModel points to.
struct Ground {
  std::vector<FieldStar> stars;
  std::vector<double> backgrounds;  ///< e- per pixel at each target; empty where it is the same everywhere
  std::shared_ptr<const PixelPsf> psf;
  GroundModel model;
};

/// A ground that knows the stars, the PSF, the mean background, the detector and the statistics of the jitter exactly.
/// @param scene  must outlive the result.
Ground perfect_ground(const Scene& scene);
/// The same with chosen targets. @param targets  indices into scene.stars(); must outlive the result.
Ground perfect_ground(const Scene& scene, std::span<const std::size_t> targets);

/// What the ground believes of the cameras of every group, and what it measures their images with.
struct GroundSegment {
  std::vector<Ground> grounds;                              ///< [group]
  std::vector<std::vector<StarEstimator>> estimators;       ///< [group][target]; of the first stretch of time
  std::vector<std::vector<EstimatorRefresh>> refreshes;     ///< [group]; of those after, where they are made anew
  std::vector<std::vector<CorrectionStretch>> corrections;  ///< [group], of jitter; each empty where there is none
};
/// Where the mission refreshes masks, the ground knows the drift of the attitude and aberration as well.
/// @param run  must outlive the result.
GroundSegment perfect_ground_segment(const PreparedRun& run);

/// The run's groups and their estimators as the stream wants them. @param ground  must outlive the result.
std::vector<StreamGroup> stream_groups(const PreparedRun& run, const GroundSegment& ground);

/// The PSF that stars of a scene have in its images. @param scene  must outlive the result.
std::shared_ptr<const PixelPsf> psf_in_images(const Scene& scene);
/// What the ground believes of the readout, and what it corrects.
CalibrationModel calibration_model(const Mission& mission);

}  // namespace astroid
