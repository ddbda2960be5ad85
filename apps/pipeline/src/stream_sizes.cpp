#include "stream_sizes.hpp"

#include <algorithm>
#include <bit>

#include "astroid/photometry/estimator.hpp"
#include "flux_block.hpp"

namespace astroid {

namespace {

constexpr std::size_t kBlockMemory = std::size_t{288} << 20;  // bytes, of both blocks
constexpr std::size_t kFrameMemory = std::size_t{64} << 20;   // bytes, of one worker

}  // namespace

std::int64_t block_length(std::int64_t exposures, std::size_t targets, int cameras, std::int64_t longest) {
  // One block is filled while the other is read; of several cameras the statistics and the file add up the mean.
  constexpr std::size_t kBlocks = 2;
  constexpr std::size_t kMeans = sizeof(double) + sizeof(float) + sizeof(std::uint8_t);
  const std::size_t bytes = std::max<std::size_t>(1, targets) * (kBlocks * sizeof(float) + (cameras > 1 ? kMeans : 0));
  // Whole batches.
  constexpr auto kUnit = static_cast<std::int64_t>(FluxBlock::kSideBySide);
  const auto fits = std::max(kUnit, static_cast<std::int64_t>(kBlockMemory / bytes) / kUnit * kUnit);
  return std::max<std::int64_t>(1, std::min({exposures, longest, fits}));
}

std::size_t batch_length(std::size_t pixels) {
  constexpr std::size_t kBytesPerPixel = sizeof(float) + sizeof(std::uint8_t);
  const std::size_t frames = kFrameMemory / (std::max<std::size_t>(1, pixels) * kBytesPerPixel);
  return std::bit_floor(std::clamp<std::size_t>(frames, 1, EstimatorSet::kMaxBatch));
}

std::vector<Batch> divide_into_batches(std::size_t count, std::size_t longest, int threads) {
  constexpr std::size_t kShortest = 4;  // below that, measuring in one go gains little
  std::vector<Batch> batches;
  for (std::size_t begin = 0; begin < count;) {
    // So that every worker gets another batch or two.
    const std::size_t share = (count - begin) / (2 * static_cast<std::size_t>(threads));
    const std::size_t wanted = std::bit_floor(std::max(share, std::size_t{1}));
    // A short run is divided further: all workers are worth more than long batches.
    const std::size_t shortest = count < kShortest * static_cast<std::size_t>(threads) ? 1 : kShortest;
    const std::size_t length = std::min({std::max(wanted, shortest), longest, count - begin});
    batches.push_back({begin, length});
    begin += length;
  }
  return batches;
}

}  // namespace astroid
