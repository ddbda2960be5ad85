// How fast this machine is: measured once, kept in a file, used by every plan for its predicted times.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "astroid/sim/cost_factors.hpp"

namespace astroid {

/// Simulates a few standard scenes for about `seconds` each and compares their parts with what plans predict.
/// @param progress  told which scene is next; may be empty.
CostFactors measure_costs(double seconds, const std::function<void(const std::string&)>& progress = {});

/// Where the factors are kept: $ASTROID_COSTS, else astroid/costs.json below $XDG_CACHE_HOME or ~/.cache.
std::filesystem::path costs_file();

/// Keeps them, with version and processor. @throws EnvironmentError
void write_costs(const CostFactors& costs, const std::filesystem::path& file);

/// What was kept; nothing where the file is missing, unreadable, or of another version or processor.
CostFactors read_costs(const std::filesystem::path& file);

}  // namespace astroid
