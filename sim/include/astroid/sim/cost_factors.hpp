// How fast this machine is, compared with the one whose times the plan knows.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace astroid {

/// Measured over predicted time of each part of an exposure: the effects by name, and ways to make the noiseless image
/// (cost_part()). Predictions are multiplied by it; decisions are not, so plans are the same on every machine.
struct CostFactors {
  std::map<std::string, double, std::less<>> parts;

  /// 1 where nothing was measured.
  [[nodiscard]] double of(std::string_view part) const {
    const auto found = parts.find(part);
    return found != parts.end() ? found->second : 1.0;
  }
};

}  // namespace astroid
