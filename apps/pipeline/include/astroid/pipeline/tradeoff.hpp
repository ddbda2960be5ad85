// What accuracy costs in time, measured for a user's own scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "astroid/analysis/tradeoff.hpp"
#include "astroid/core/configuration.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

struct TradeoffOptions {
  std::int64_t exposures = 64;  ///< that methods of photometry are compared on
  double seconds = 0.2;         ///< that each timing takes
};

struct TradeoffResult {
  std::vector<TradeoffRow> rows;
  double photon_noise = 0.0;        ///< ppm, of the brightest unsaturated target in one exposure of one camera
  double photon_noise_bin = 0.0;    ///< and in a bin of all cameras
  std::vector<std::string> advice;  ///< in words, with the settings to paste
  std::vector<std::string> warnings;
};

/// Sweeps renderers, Simulation/Accuracy, methods of photometry, effects and the length of series, measures errors
/// against a converged reference and CPU times on one core, and writes analysis/tradeoff.csv and figures into a folder
/// of products.
///
/// Errors are of fluxes in 3 × 3 px without any noise. Renderers: stars at 200 places of the middle pixel, and on a
/// drift of 1.3 px. Accuracy: every target of the scene with its neighbours, in three exposures with the same attitude,
/// against an accuracy of 0.001 ppm. Effects: the same draws with and without. Of several groups of cameras, the first.
/// @param progress  told what is measured next; may be empty.
/// @throws InputError, EnvironmentError
TradeoffResult measure_tradeoff(const ResolvedConfiguration& configuration, const RunOptions& options,
                                const TradeoffOptions& tradeoff,
                                const std::function<void(const std::string&)>& progress = {});

}  // namespace astroid
