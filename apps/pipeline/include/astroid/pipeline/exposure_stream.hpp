// The stream of exposures: simulate, measure, accumulate, write; memory does not grow with the number of exposures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "astroid/analysis/nsr_accumulator.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/pipeline/attitude_correction.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// What a stream reports while it runs: exposures done and in all (of every camera).
using Progress = std::function<void(std::int64_t done, std::int64_t all)>;

struct StreamOptions {
  int threads = 1;
  std::filesystem::path folder;       ///< products go to folder/images, folder/photometry, folder/steps; empty: nowhere
  Progress progress;                  ///< called by several threads at a time
  std::int64_t longest_block = 1024;  ///< exposures held in memory at a time, at most; results do not depend on it
};

/// CPU seconds by stage, summed over the workers, and wall seconds of the whole.
struct StreamTimings {
  double prepare = 0.0;  ///< fixed patterns, attitude, noiseless image
  double simulate = 0.0;
  double measure = 0.0;
  double images = 0.0;  ///< writing frames
  double statistics = 0.0;
  double light_curves = 0.0;
  double wall = 0.0;
};

/// What a stream leaves besides its files.
struct StreamResult {
  std::vector<SeriesSummary> series;    ///< of each target, mean of the simulated cameras
  std::vector<SeriesSummary> measured;  ///< the same before jitter correction; empty without one
  std::vector<float> bin_means;         ///< of each target, [target][bin], where they are cotrended; else empty
  std::vector<double> reference;        ///< flux the series are relative to, e- per exposure, mean of the cameras
  std::vector<std::uint32_t> flags;     ///< measurement_flag bits seen in any exposure, of each target
  std::vector<double> flagged_share;    ///< share of exposures of a target with any flag
  Image<float, unit::Adu> first_frame;  ///< exposure 0 of camera 0, largest region
  StreamTimings timings;
  std::vector<std::pair<std::string, double>> effect_seconds;  ///< share of each effect that ran in timings.simulate
  double lost_electrons = 0.0;
  std::int64_t clipped_pixels = 0;
  std::int64_t images_written = 0;
};

/// Estimators that hold from an exposure on.
struct EstimatorRefresh {
  std::int64_t first = 0;                 ///< exposure
  std::vector<StarEstimator> estimators;  ///< of the same targets
};

/// Cameras that see the same: what, how, and measured by what.
struct StreamGroup {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  std::span<const StarEstimator> estimators;  ///< of the targets, which are the same stars in every group
  double share = 1.0;                         ///< of the group in all cameras
  /// Those that follow `estimators`, which hold from exposure 0 on; ascending. Fluxes are relative to what the
  /// estimators of their time expect.
  std::span<const EstimatorRefresh> refreshes{};
  /// Of the targets' fluxes; empty: none.
  std::span<const CorrectionStretch> corrections{};
};

/// Runs all exposures of all simulated cameras, numbered through the groups by group_of_camera().
///
/// Workers make and measure batches of exposures, each with a state and frames of its own. Fluxes collect in a block;
/// while the next block is filled, the stars of the complete one go to the statistics and the light-curve file, every
/// star by one worker, so results are the same for any number of threads and any division into batches and blocks.
/// Memory: two blocks and, with several cameras, sums for their mean, 300 MB in all for up to 800,000 targets; and for
/// each worker a state and the frames of a batch, 64 MB of them at most but at least one frame
/// (test: StreamMemory.DoesNotGrowWithTheExposures).
/// @throws EnvironmentError when a product cannot be written.
StreamResult stream_exposures(std::span<const StreamGroup> groups, const StreamOptions& options);

/// The same where all cameras are alike.
/// @param estimators  of the targets; empty: images only.
StreamResult stream_exposures(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const Plan>& plan,
                              const std::vector<StarEstimator>& estimators, const StreamOptions& options);

}  // namespace astroid
