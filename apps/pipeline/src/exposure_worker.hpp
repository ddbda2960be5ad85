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

/// What all workers read.
struct StreamInput {
  const Mission& mission;
  std::span<const Simulator> simulators;  ///< by camera
  const FrameCalibration& calibration;
  const EstimatorSet& estimators;
  std::span<const double> reference;         ///< e- per exposure, of each target
  std::span<const std::uint32_t> own_flags;  ///< that hold for every exposure, of each target
  const ImageFiles& images;
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
  [[nodiscard]] const ExposureState& state() const { return state_; }
  [[nodiscard]] std::int64_t images_written() const { return images_written_; }
  /// Exposure 0 of camera 0, if this worker made it.
  [[nodiscard]] Image<float, unit::Adu>& first_frame() { return first_frame_; }

 private:
  void simulate(int camera, std::int64_t exposure);
  void measure(Batch batch, FluxBlock& block);
  void note_flags(std::size_t target, std::span<const std::uint32_t> flags, const FluxBlock& block, std::size_t begin);

  StreamInput input_;
  ExposureState state_;
  std::vector<Frame> frames_;  // of a batch
  EstimatorSet::BatchScratch scratch_;
  FrameCalibration::Scratch calibration_scratch_;
  std::vector<LightCurveFlag> flags_;
  StreamTimings seconds_;
  std::int64_t images_written_ = 0;
  Image<float, unit::Adu> first_frame_;
};

}  // namespace astroid
