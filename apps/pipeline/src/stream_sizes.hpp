// How the stream divides exposures: into blocks that memory holds, and into batches that a worker measures in one go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace astroid {

/// Exposures in a block: about a thousand, fewer where blocks of so many targets would need too much memory.
/// @param longest  at most so many.
[[nodiscard]] std::int64_t block_length(std::int64_t exposures, std::size_t targets, int cameras, std::int64_t longest);

/// Exposures in a batch: as many as can be measured in one go while the frames of a worker stay below 64 MB, one for
/// very large frames.
[[nodiscard]] std::size_t batch_length(std::size_t pixels);

/// Exposures of a block, in a row.
struct Batch {
  std::size_t begin = 0;  ///< place of the first in the block
  std::size_t count = 0;
};

/// Divides a block among workers: batches of `longest`, and shorter ones towards the end, so that workers end together.
/// Batches are powers of two, longer ones first, but for a remainder at the end: none crosses a multiple of `longest`.
/// @param longest  a power of two.
[[nodiscard]] std::vector<Batch> divide_into_batches(std::size_t count, std::size_t longest, int threads);

}  // namespace astroid
