// The parts of a tradeoff.
#pragma once

#include <ctime>
#include <functional>
#include <span>
#include <vector>

#include "astroid/analysis/tradeoff.hpp"
#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/configuration.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid::tradeoff {

/// A reported number is of this many px² around a star.
inline constexpr int kMaskSide = 3;

/// CPU time of this thread so far, s.
double cpu_seconds();
/// Median CPU time of one call, over calls that take `seconds` together, five at least.
double median_seconds(const std::function<void()>& call, double seconds);

/// Stars at places of a pixel, and on a drift, with every way to make them.
std::vector<TradeoffRow> sweep_renderers(const PreparedGroup& run, double seconds);
/// The scene at other accuracies.
std::vector<TradeoffRow> sweep_accuracy(const Mission& mission, const StarCatalogue& catalogue, double seconds);
/// The scene measured by every method.
std::vector<TradeoffRow> sweep_photometry(const ResolvedConfiguration& configuration, const StarCatalogue& catalogue,
                                          std::int64_t exposures, int threads);
/// Every effect that runs, left out.
std::vector<TradeoffRow> sweep_effects(const PreparedGroup& run, double seconds);
/// Series of 2, 4, 8 … bins. @param exposure_seconds  of all cameras that are simulated
std::vector<TradeoffRow> sweep_series(const Mission& mission, double exposure_seconds, double seconds_once);

}  // namespace astroid::tradeoff
