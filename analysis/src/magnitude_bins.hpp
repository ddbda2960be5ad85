// Stars sorted into bins of magnitude.
#pragma once

#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "astroid/analysis/target_metrics.hpp"

namespace astroid {

/// Targets by the number of their bin, floor(mag / width). Magnitudes that are not finite are left out.
inline std::map<long, std::vector<const TargetMetrics*>> by_magnitude(std::span<const TargetMetrics> targets,
                                                                      double width) {
  std::map<long, std::vector<const TargetMetrics*>> bins;
  for (const TargetMetrics& target : targets) {
    if (std::isfinite(target.mag)) bins[std::lround(std::floor(target.mag / width))].push_back(&target);
  }
  return bins;
}

}  // namespace astroid
