#include "series_stage.hpp"

#include <algorithm>

#include "stage_clock.hpp"

namespace astroid {

namespace {

constexpr std::size_t kStarsPerTask = 64;  // so that their series in a block fit the second cache

}  // namespace

SeriesStage::SeriesStage(std::span<const std::uint32_t> own_flags, int cameras, std::int64_t exposures_per_bin,
                         std::size_t longest_block, LightCurveWriter* light_curves)
    : own_flags_(own_flags.begin(), own_flags.end()),
      cameras_(static_cast<std::size_t>(cameras)),
      statistics_(own_flags.size(), exposures_per_bin),
      light_curves_(light_curves),
      longest_block_(longest_block),
      mean_(cameras > 1 ? longest_block * own_flags.size() : 0),
      flags_(own_flags.size(), 0),
      flagged_(own_flags.size(), 0) {}

void SeriesStage::begin(const FluxBlock& block) {
  if (light_curves_ != nullptr && !block.empty())
    light_curves_->begin_block(block.camera() + 1, block.first(), block.count());
}

std::size_t SeriesStage::tasks(const FluxBlock& block) const {
  return block.empty() ? 0 : (own_flags_.size() + kStarsPerTask - 1) / kStarsPerTask;
}

void SeriesStage::run(std::size_t task, const FluxBlock& block, StreamTimings& seconds) {
  StageClock clock;
  const std::size_t begin = task * kStarsPerTask;
  const std::size_t end = std::min(own_flags_.size(), begin + kStarsPerTask);
  std::vector<float> series;
  block.copy_series(begin, end, series);
  const auto series_of = [&](std::size_t target) {
    return std::span<const float>(series).subspan((target - begin) * block.count(), block.count());
  };
  for (std::size_t target = begin; target < end; ++target) {
    if (cameras_ == 1)
      statistics_.add(target, block.first(), series_of(target));
    else
      add_to_mean(target, block, series_of(target));
  }
  clock.charge(seconds.statistics);
  if (light_curves_ == nullptr) return;
  for (std::size_t target = begin; target < end; ++target) light_curves_->write_star(target, series_of(target));
  clock.charge(seconds.light_curves);
}

void SeriesStage::add_to_mean(std::size_t target, const FluxBlock& block, std::span<const float> series) {
  const std::span<double> mean = std::span(mean_).subspan(target * longest_block_, block.count());
  if (block.camera() == 0) std::ranges::fill(mean, 0.0);
  const auto cameras = static_cast<double>(cameras_);
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += static_cast<double>(series[k]) / cameras;
  if (static_cast<std::size_t>(block.camera()) + 1 < cameras_) return;
  std::vector<float> combined(mean.size());
  for (std::size_t k = 0; k < mean.size(); ++k) combined[k] = static_cast<float>(mean[k]);
  statistics_.add(target, block.first(), combined);
}

void SeriesStage::end(const FluxBlock& block, std::vector<LightCurveFlag>& flags) {
  if (block.empty()) return;
  exposures_ += static_cast<std::int64_t>(block.count());
  for (std::size_t target = 0; target < flags_.size(); ++target) flags_[target] |= own_flags_[target];
  join_flags(flags);
  for (const LightCurveFlag& flag : flags) {
    flags_[flag.star] |= flag.flags;
    flagged_[flag.star] += flag.exposures;
  }
  if (light_curves_ == nullptr) return;
  light_curves_->end_block();
  light_curves_->add_flags(flags);
}

std::vector<double> SeriesStage::flagged_share() const {
  std::vector<double> share;
  share.reserve(flagged_.size());
  for (std::size_t target = 0; target < flagged_.size(); ++target) {
    const std::int64_t flagged = own_flags_[target] != 0 ? exposures_ : flagged_[target];
    share.push_back(static_cast<double>(flagged) / static_cast<double>(exposures_));
  }
  return share;
}

}  // namespace astroid
