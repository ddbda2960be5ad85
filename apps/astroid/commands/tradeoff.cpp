#include "astroid/pipeline/tradeoff.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/run_options.hpp"

namespace astroid::commands {

namespace {

/// A number, or nothing where there is none.
std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : std::string();
}

}  // namespace

int tradeoff(const TradeoffCommand& options) {
  const ResolvedConfiguration configuration = read(options.run.configuration, {});
  const TradeoffResult result = measure_tradeoff(
      configuration, run_options(options.run, ""), {.exposures = options.exposures, .seconds = options.seconds},
      [](const std::string& what) { fmt::print(stderr, "measuring {} ...\n", what); });
  Sweep sweep = Sweep::kSeries;
  bool first = true;
  for (const TradeoffRow& row : result.rows) {
    if (first || row.sweep != sweep) {
      sweep = row.sweep;
      fmt::print("{}{:<34} {:>10} {:>10} {:>10} {:>8} {:>12} {:>9}\n", first ? "" : "\n", to_string(sweep), "rms ppm",
                 "max ppm",
                 sweep == Sweep::kRenderer   ? "drift ppm"
                 : sweep == Sweep::kAccuracy ? "of promise"
                                             : "",
                 sweep == Sweep::kPhotometry ? "/ bound"
                 : sweep == Sweep::kSeries   ? "error"
                                             : "",
                 "ms/1000stars", "s once");
      first = false;
    }
    fmt::print("{:<34} {:>10} {:>10} {:>10} {:>8} {:>12} {:>9} {}{}\n", row.setting, cell(row.error_rms),
               cell(row.error_max), cell(sweep == Sweep::kAccuracy ? row.of_promise : row.error_drift),
               cell(sweep == Sweep::kPhotometry ? row.noise_over_bound : row.nsr_error), cell(1e3 * row.seconds),
               cell(row.seconds_once), row.pareto ? "*" : " ", row.chosen ? " <- configured" : "");
  }
  fmt::print("\n* nothing is both faster and more accurate\n\n");
  for (const std::string& line : result.advice) fmt::print("{}\n", line);
  for (const std::string& warning : result.warnings) fmt::print("note: {}\n", warning);
  fmt::print("\nNumbers: {0}/analysis/tradeoff.csv, figures: {0}/report/figures\n", options.run.run.folder);
  return 0;
}

}  // namespace astroid::commands
