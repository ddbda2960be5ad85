#include "astroid/reports/tables.hpp"

namespace astroid {

namespace {

Column<TradeoffRow> number(const char* name, const char* unit, const char* meaning, double TradeoffRow::*of) {
  return {name, unit, meaning, [of](const TradeoffRow& r) { return Cell(r.*of); }};
}

Column<TradeoffRow> yes_or_no(const char* name, const char* meaning, bool TradeoffRow::*of) {
  return {name, "", meaning, [of](const TradeoffRow& r) { return Cell(static_cast<std::int64_t>(r.*of)); }};
}

}  // namespace

std::span<const Column<TradeoffRow>> tradeoff_columns() {
  static const std::vector<Column<TradeoffRow>> columns = {
      {"sweep", "", "renderer, accuracy, photometry, effect or series",
       [](const TradeoffRow& r) { return Cell(to_string(r.sweep)); }},
      {"setting", "", "in words", [](const TradeoffRow& r) { return Cell(r.setting); }},
      {"parameter", "", "to paste after --set; empty for other tools' methods",
       [](const TradeoffRow& r) { return Cell(r.parameter); }},
      number("value", "", "of what is swept: sub-pixels, nodes or phases per axis, ppm, bins", &TradeoffRow::value),
      number("error_rms_ppm", "ppm",
             "systematic error of fluxes in 3 x 3 px against the converged reference, rms over places or stars; of "
             "photometry the median bias of a star",
             &TradeoffRow::error_rms),
      number("error_max_ppm", "ppm", "the largest; of photometry the 95th percentile", &TradeoffRow::error_max),
      number("error_drift_ppm", "ppm", "rms about its mean of the error of a star that drifts by 1.3 px",
             &TradeoffRow::error_drift),
      number("promised_ppm", "ppm",
             "the error is promised to stay below it, or below 1 % of a star's noise where that is more",
             &TradeoffRow::promised),
      number("of_promise", "", "largest error of any star over what it is promised", &TradeoffRow::of_promise),
      number("noise_over_bound", "", "measured noise over the Cramer-Rao bound of a star alone",
             &TradeoffRow::noise_over_bound),
      number("nsr_error", "", "relative standard error of one star's noise after a series", &TradeoffRow::nsr_error),
      number("cpu_s_per_1000_stars", "s",
             "CPU time of an exposure on one core, per 1000 stars; of an effect what leaving it out saves",
             &TradeoffRow::seconds),
      number("cpu_s_once", "s", "CPU time before the first exposure; of a series all of it",
             &TradeoffRow::seconds_once),
      number("memory_mib", "MiB", "tables of other tools' methods; of the scene what the plan predicts for each worker",
             &TradeoffRow::memory),
      number("operations", "", "multiplications of making the scene's image once", &TradeoffRow::operations),
      yes_or_no("pareto", "1: nothing is both faster and more accurate", &TradeoffRow::pareto),
      yes_or_no("chosen", "1: the configuration as it is", &TradeoffRow::chosen),
  };
  return columns;
}

}  // namespace astroid
