// What accuracy costs: table, figures and advice.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/tradeoff.hpp"

namespace astroid {

struct TradeoffInput {
  std::span<const TradeoffRow> rows;
  double photon_noise = 0.0;      ///< ppm, of the brightest unsaturated target in one exposure of one camera
  double photon_noise_bin = 0.0;  ///< and in a bin of all cameras
  std::span<const std::string> advice;
  int threads = 0;
};

/// Writes analysis/tradeoff.csv, report/tradeoff.txt (the advice) and report/figures/tradeoff_*.
/// @returns what could not be drawn. @throws EnvironmentError(path, cause)
std::vector<std::string> write_tradeoff(const std::filesystem::path& folder, const TradeoffInput& input);

}  // namespace astroid
