// One worker of the stream: simulates batches of exposures and measures them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "astroid/photometry/calibration.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/sim/simulator.hpp"
#include "flux_block.hpp"
#include "image_files.hpp"
#include "stream_sizes.hpp"

namespace astroid {

/// What measures the exposures from `first` on.
struct EstimatorStretch {
  std::int64_t first = 0;
  EstimatorSet estimators;
  std::vector<double> reference;  ///< e- per exposure, of each target
};

/// How the images of cameras that see the same are measured and written.
struct GroupInput {
  const Mission& mission;
  FrameCalibration calibration;
  std::vector<EstimatorStretch> stretches;         ///< ascending; the first from exposure 0 on
  std::vector<std::uint32_t> own_flags;            ///< that hold for every exposure, of each target
  std::span<const CorrectionStretch> corrections;  ///< empty: none
  ImageFiles images;
};

/// What all workers read.
struct StreamInput {
  std::span<const Simulator> simulators;  ///< by camera
  std::span<const std::size_t> group_of;  ///< by camera
  std::span<const GroupInput> groups;
  const Progress& progress;
};

/// Owns what one thread needs to make and measure exposures.
class ExposureWorker {
 public:
  ExposureWorker(const StreamInput& input, std::size_t longest_batch);

  /// Makes, writes and measures the exposures of one batch of a block.
  /// @param done  exposures done by all workers, counted here.
  void run(Batch batch, FluxBlock& block, std::atomic<std::int64_t>& done);

  /// Moves the flags found since the last call to the end of a list: those that targets have only in some exposures.
  void take_flags(std::vector<LightCurveFlag>& flags);

  [[nodiscard]] StreamTimings& seconds() { return seconds_; }
  /// Wall seconds of each effect of the plan.
  [[nodiscard]] std::vector<double> effect_seconds() const;
  [[nodiscard]] std::int64_t images_written() const { return images_written_; }
  /// Exposure 0 of camera 0, if this worker made it.
  [[nodiscard]] Image<float, unit::Adu>& first_frame() { return first_frame_; }

 private:
  void turn_to(int camera);
  [[nodiscard]] const GroupInput& group() const { return input_.groups[group_]; }
  void simulate(int camera, std::int64_t exposure);
  void measure(Batch batch, FluxBlock& block);
  void measure(const EstimatorStretch& stretch, Batch batch, std::span<const Frame> frames, FluxBlock& block);
  void note_flags(std::size_t target, std::span<const std::uint32_t> flags, const FluxBlock& block, std::size_t begin);

  StreamInput input_;
  std::size_t longest_batch_;
  std::size_t group_;  // whose pixels state and frames have
  ExposureState state_;
  std::vector<Frame> frames_;           // of a batch
  std::vector<double> effect_seconds_;  // of groups before
  EstimatorSet::BatchScratch scratch_;
  FrameCalibration::Scratch calibration_scratch_;
  std::vector<LightCurveFlag> flags_;
  StreamTimings seconds_;
  std::int64_t images_written_ = 0;
  Image<float, unit::Adu> first_frame_;
};

}  // namespace astroid
