#include "astroid/analysis/tradeoff.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {

std::string to_string(Sweep sweep) {
  switch (sweep) {
    case Sweep::kRenderer:
      return "renderer";
    case Sweep::kAccuracy:
      return "accuracy";
    case Sweep::kPhotometry:
      return "photometry";
    case Sweep::kEffect:
      return "effect";
    case Sweep::kSeries:
      return "series";
  }
  throw BugError("unknown sweep");
}

void mark_pareto(std::span<TradeoffRow> rows, double noise, double floor) {
  const auto error = [&](const TradeoffRow& row) { return std::max(row.error_rms, floor); };
  for (TradeoffRow& row : rows) {
    if (!std::isfinite(row.error_rms) || !std::isfinite(row.seconds)) continue;
    row.pareto = std::ranges::none_of(rows, [&](const TradeoffRow& other) {
      if (&other == &row || other.sweep != row.sweep || !std::isfinite(other.error_rms)) return false;
      const bool faster = other.seconds < row.seconds * (1.0 - noise);
      const bool no_slower = other.seconds < row.seconds * (1.0 + noise);
      return (faster && error(other) <= error(row)) || (no_slower && error(other) < error(row));
    });
  }
}

std::size_t knee(std::span<const TradeoffRow> rows, Sweep sweep, double most) {
  std::size_t best = rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TradeoffRow& row = rows[i];
    if (row.sweep != sweep || !(row.error_rms < most)) continue;
    if (best == rows.size() || row.seconds < rows[best].seconds) best = i;
  }
  return best;
}

}  // namespace astroid
