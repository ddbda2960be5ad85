#include "flux_block.hpp"

#include <algorithm>

#include "astroid/core/error.hpp"

namespace astroid {

FluxBlock::FluxBlock(std::size_t targets, std::size_t longest)
    : targets_(targets),
      deviation_((longest + kSideBySide - 1) / kSideBySide * targets),
      attitudes_(longest),
      lost_(longest),
      clipped_(longest) {}

void FluxBlock::begin(int camera, std::int64_t first, std::size_t count) {
  ASTROID_CHECK_LE(count, lost_.size());
  camera_ = camera;
  first_ = first;
  count_ = count;
}

void FluxBlock::copy_series(std::size_t first_target, std::size_t last_target, std::vector<float>& out) const {
  out.resize((last_target - first_target) * count_);
  for (std::size_t begin = 0; begin < count_; begin += kSideBySide) {
    const std::size_t exposures = std::min(kSideBySide, count_ - begin);
    const Line* lines = &deviation_[begin / kSideBySide * targets_];
    for (std::size_t target = first_target; target < last_target; ++target)
      std::copy_n(lines[target].begin(), exposures,
                  out.begin() + static_cast<std::ptrdiff_t>((target - first_target) * count_ + begin));
  }
}

}  // namespace astroid
