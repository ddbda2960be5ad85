#include "exposure_worker.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "astroid/photometry/background.hpp"
#include "stage_clock.hpp"

namespace astroid {

namespace {

/// Takes the mesh background out of a measured frame; written images keep theirs.
void subtract_mesh(Frame& frame, const PhotometrySettings& settings) {
  for (std::size_t r = 0; r < frame.pixels.layout().exposed_regions().size(); ++r) {
    const BackgroundMap map(frame, r, {.cell = settings.mesh});
    subtract_background(frame, r, map);
  }
}

}  // namespace

ExposureWorker::ExposureWorker(const StreamInput& input, std::size_t longest_batch)
    : input_(input),
      longest_batch_(longest_batch),
      group_(input.groups.size()),
      effect_seconds_(input.simulators.front().make_state().effect_seconds.size(), 0.0) {
  turn_to(0);
}

void ExposureWorker::turn_to(int camera) {
  const auto c = static_cast<std::size_t>(camera);
  if (input_.group_of[c] == group_) return;
  effect_seconds_ = effect_seconds();
  group_ = input_.group_of[c];
  state_ = input_.simulators[c].make_state();
  frames_.clear();
  for (std::size_t i = 0; i < longest_batch_; ++i) frames_.push_back(input_.simulators[c].make_state().frame);
}

std::vector<double> ExposureWorker::effect_seconds() const {
  std::vector<double> sum = effect_seconds_;
  for (std::size_t i = 0; i < state_.effect_seconds.size(); ++i) sum[i] += state_.effect_seconds[i];
  return sum;
}

void ExposureWorker::run(Batch batch, FluxBlock& block, std::atomic<std::int64_t>& done) {
  turn_to(block.camera());
  for (std::size_t i = 0; i < batch.count; ++i) {
    simulate(block.camera(), block.first() + static_cast<std::int64_t>(batch.begin + i));
    block.attitudes()[batch.begin + i] = state_.attitude.mean;
    block.lost()[batch.begin + i] = state_.lost_electrons;
    block.clipped()[batch.begin + i] = state_.clipped_pixels;
    std::swap(state_.frame, frames_[i]);
  }
  if (group().stretches.front().estimators.size() > 0) measure(batch, block);
  if (!input_.progress) return;
  const auto all = group().mission.simulation.exposures * static_cast<std::int64_t>(input_.simulators.size());
  for (std::size_t i = 0; i < batch.count; ++i) input_.progress(++done, all);
}

void ExposureWorker::simulate(int camera, std::int64_t exposure) {
  StageClock clock;
  const Simulator& simulator = input_.simulators[static_cast<std::size_t>(camera)];
  if (group().images.dumps(camera, exposure)) {
    simulator.simulate(exposure, state_, group().images.step_writer(camera, exposure));
  } else {
    simulator.simulate(exposure, state_);
  }
  clock.charge(seconds_.simulate);
  if (group().images.writes(camera, exposure)) {
    group().images.write(state_.frame);
    ++images_written_;
    clock.charge(seconds_.images);
  }
  if (camera == 0 && exposure == 0) first_frame_ = largest_region(state_.frame);
}

void ExposureWorker::measure(Batch batch, FluxBlock& block) {
  StageClock clock;
  const std::span<Frame> frames = std::span(frames_).first(batch.count);
  if (!group().calibration.does_nothing())
    for (Frame& frame : frames) group().calibration.apply(frame, calibration_scratch_);
  if (group().mission.photometry.background == BackgroundMethod::kMesh)
    for (Frame& frame : frames) subtract_mesh(frame, group().mission.photometry);
  if (!group().corrections.empty())
    for (std::size_t i = 0; i < batch.count; ++i) {
      const std::int64_t exposure = block.first() + static_cast<std::int64_t>(batch.begin + i);
      Attitude& attitude = block.attitudes()[batch.begin + i];
      attitude = correction_at(group().corrections, exposure).attitude(exposure, attitude, frames[i]);
    }
  // Frames on either side of a refresh are measured by themselves.
  for (std::size_t begin = 0; begin < batch.count;) {
    const std::int64_t exposure = block.first() + static_cast<std::int64_t>(batch.begin + begin);
    const auto next = std::ranges::upper_bound(group().stretches, exposure, {}, &EstimatorStretch::first);
    std::size_t count = batch.count - begin;
    if (next != group().stretches.end()) count = std::min(count, static_cast<std::size_t>(next->first - exposure));
    measure(*std::prev(next), {batch.begin + begin, count}, frames.subspan(begin, count), block);
    begin += count;
  }
  clock.charge(seconds_.measure);
}

void ExposureWorker::measure(const EstimatorStretch& stretch, Batch batch, std::span<const Frame> frames,
                             FluxBlock& block) {
  stretch.estimators.apply_batch(
      frames, scratch_, [&](std::size_t target, std::span<const double> flux, std::span<const std::uint32_t> flags) {
        const double reference = stretch.reference[target];
        const std::span<float> series = block.deviation(target, batch.begin, batch.count);
        for (std::size_t k = 0; k < flux.size(); ++k) series[k] = static_cast<float>(flux[k] / reference - 1.0);
        note_flags(target, flags, block, batch.begin);
      });
}

void ExposureWorker::note_flags(std::size_t target, std::span<const std::uint32_t> flags, const FluxBlock& block,
                                std::size_t begin) {
  const std::uint32_t own = group().own_flags[target];
  std::uint32_t others = 0;
  for (const std::uint32_t flag : flags) others |= flag ^ own;
  if (others == 0) return;
  for (std::size_t k = 0; k < flags.size(); ++k) {
    // What holds for every exposure stands in the table of stars.
    const std::uint32_t flag = flags[k] & ~own;
    if (flag == 0) continue;
    if (k > 0 && (flags[k - 1] & ~own) == flag) {
      ++flags_.back().exposures;
      continue;
    }
    flags_.push_back({.camera = static_cast<std::uint32_t>(block.camera() + 1),
                      .star = static_cast<std::uint32_t>(target),
                      .exposure = block.first() + static_cast<std::int64_t>(begin + k),
                      .flags = flag,
                      .exposures = 1});
  }
}

void ExposureWorker::take_flags(std::vector<LightCurveFlag>& flags) {
  flags.insert(flags.end(), flags_.begin(), flags_.end());
  flags_.clear();
}

}  // namespace astroid
