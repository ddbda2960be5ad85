#include "series_stage.hpp"

#include <algorithm>
#include <utility>

#include "stage_clock.hpp"

namespace astroid {

namespace {

constexpr std::size_t kStarsPerTask = 64;  // so that their series in a block fit the second cache

}  // namespace

SeriesStage::SeriesStage(std::vector<std::vector<std::uint32_t>> own_flags,
                         std::vector<std::span<const CorrectionStretch>> corrections, std::int64_t exposures_per_bin,
                         bool keep_bin_means, std::size_t longest_block, LightCurveWriter* light_curves)
    : own_flags_(std::move(own_flags)),
      corrections_(std::move(corrections)),
      cameras_(own_flags_.size()),
      targets_(own_flags_.front().size()),
      light_curves_(light_curves),
      longest_block_(longest_block),
      result_(make_mean(targets_, exposures_per_bin, keep_bin_means)),
      measured_(make_mean(corrections_.empty() ? 0 : targets_, exposures_per_bin, false)),
      flags_(targets_, 0),
      flagged_(targets_, 0) {}

SeriesStage::Mean SeriesStage::make_mean(std::size_t targets, std::int64_t exposures_per_bin,
                                         bool keep_bin_means) const {
  return {.statistics = SeriesStatistics(targets, exposures_per_bin, keep_bin_means),
          .sums = std::vector<double>(cameras_ > 1 ? longest_block_ * targets : 0)};
}

void SeriesStage::begin(const FluxBlock& block) {
  if (light_curves_ != nullptr && !block.empty())
    light_curves_->begin_block(block.camera() + 1, block.first(), block.count());
}

std::size_t SeriesStage::tasks(const FluxBlock& block) const {
  return block.empty() ? 0 : (targets_ + kStarsPerTask - 1) / kStarsPerTask;
}

void SeriesStage::run(std::size_t task, const FluxBlock& block, StreamTimings& seconds) {
  StageClock clock;
  const std::size_t begin = task * kStarsPerTask;
  const std::size_t end = std::min(targets_, begin + kStarsPerTask);
  std::vector<float> series;
  block.copy_series(begin, end, series);
  const auto series_of = [&](std::size_t target) {
    return std::span(series).subspan((target - begin) * block.count(), block.count());
  };
  for (std::size_t target = begin; target < end; ++target) {
    if (!corrections_.empty()) {
      add(measured_, target, block, series_of(target));
      correct(target, block, series_of(target));
    }
    add(result_, target, block, series_of(target));
  }
  clock.charge(seconds.statistics);
  if (light_curves_ == nullptr) return;
  for (std::size_t target = begin; target < end; ++target) light_curves_->write_star(target, series_of(target));
  clock.charge(seconds.light_curves);
}

void SeriesStage::correct(std::size_t target, const FluxBlock& block, std::span<float> series) const {
  const std::span<const CorrectionStretch> stretches = corrections_[static_cast<std::size_t>(block.camera())];
  for (std::size_t k = 0; k < series.size(); ++k) {
    const AttitudeCorrection& correction = correction_at(stretches, block.first() + static_cast<std::int64_t>(k));
    series[k] = static_cast<float>(
        without_attitude(static_cast<double>(series[k]), correction.responses()[target], block.attitudes()[k]));
  }
}

void SeriesStage::add(Mean& mean, std::size_t target, const FluxBlock& block, std::span<const float> series) const {
  if (cameras_ == 1) {
    mean.statistics.add(target, block.first(), series);
    return;
  }
  const std::span<double> sums = std::span(mean.sums).subspan(target * longest_block_, block.count());
  if (block.camera() == 0) std::ranges::fill(sums, 0.0);
  const auto cameras = static_cast<double>(cameras_);
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += static_cast<double>(series[k]) / cameras;
  if (static_cast<std::size_t>(block.camera()) + 1 < cameras_) return;
  std::vector<float> combined(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) combined[k] = static_cast<float>(sums[k]);
  mean.statistics.add(target, block.first(), combined);
}

std::vector<SeriesSummary> SeriesStage::measured_summaries() const {
  return corrections_.empty() ? std::vector<SeriesSummary>() : measured_.statistics.summaries();
}

void SeriesStage::end(const FluxBlock& block, std::vector<LightCurveFlag>& flags) {
  if (block.empty()) return;
  exposures_ += static_cast<std::int64_t>(block.count());
  const std::vector<std::uint32_t>& own = own_flags_[static_cast<std::size_t>(block.camera())];
  for (std::size_t target = 0; target < targets_; ++target) {
    flags_[target] |= own[target];
    if (own[target] != 0) flagged_[target] += static_cast<std::int64_t>(block.count());
  }
  join_flags(flags);
  for (const LightCurveFlag& flag : flags) {
    flags_[flag.star] |= flag.flags;
    if (own[flag.star] == 0) flagged_[flag.star] += flag.exposures;
  }
  if (light_curves_ == nullptr) return;
  light_curves_->end_block();
  if (!corrections_.empty()) light_curves_->add_attitudes(block.camera() + 1, block.attitudes());
  light_curves_->add_flags(flags);
}

std::vector<double> SeriesStage::flagged_share() const {
  std::vector<double> share;
  share.reserve(flagged_.size());
  for (const std::int64_t flagged : flagged_)
    share.push_back(static_cast<double>(flagged) / static_cast<double>(exposures_));
  return share;
}

}  // namespace astroid
