// What lies in the pixels around every target.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "astroid/sim/scene.hpp"
#include "sweeps.hpp"

namespace astroid::tradeoff {

/// Appends the sum of value(region, x, y) over kMaskSide² px around each target; NaN where they are not all in one
/// region of the layout.
template <class Value>
void append_target_sums(const Scene& scene, const PixelLayout& layout, const Value& value, std::vector<double>& sums) {
  const auto regions = layout.regions();
  for (const std::size_t target : scene.targets()) {
    const PixelPosition p = scene.stars()[target].position;
    const Rectangle mask{static_cast<int>(std::lround(p.x)) - kMaskSide / 2,
                         static_cast<int>(std::lround(p.y)) - kMaskSide / 2, kMaskSide, kMaskSide};
    std::size_t r = 0;
    while (r < regions.size() && intersect(regions[r], mask).size() != mask.size()) ++r;
    double sum = r < regions.size() ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    if (r < regions.size())
      for (int y = mask.y0; y < mask.y1(); ++y)
        for (int x = mask.x0; x < mask.x1(); ++x) sum += value(r, x, y);
    sums.push_back(sum);
  }
}

}  // namespace astroid::tradeoff
