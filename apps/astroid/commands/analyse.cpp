#include <fmt/format.h>

#include <filesystem>

#include "astroid/core/error.hpp"
#include "astroid/pipeline/analyse_run.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

namespace {

int compare(const AnalyseOptions& options) {
  if (options.truth.empty() || options.sources.empty())
    throw InputError(Problem{.parameter = "DIR",
                             .expected = "the folder of a run, or both --truth and --sources",
                             .message = "nothing to analyse"});
  require_files({options.truth, options.sources});
  const std::string output = options.output.empty() ? "out/analyse" : options.output;
  if (std::filesystem::exists(output) && !options.overwrite)
    throw InputError(
        Problem{.file = output, .expected = "another -o DIR, or --overwrite", .message = "the folder exists"});
  const TableComparison result = compare_tables(options.truth, options.sources, output);
  for (const std::string& note : result.notes) fmt::print("{}\n", note);
  fmt::print("{} of {} true stars matched with {} sources; bias {:+.3f} ± {:.3f} mmag, pull width {:.3f}\n",
             result.matched, result.truth, result.sources, result.bias_mmag, result.bias_error_mmag, result.pull_width);
  fmt::print("Tables: {0}/matched.csv, {0}/magnitude_recovery.csv\n", output);
  return 0;
}

}  // namespace

int analyse(const AnalyseOptions& options) {
  if (options.folder.empty()) return compare(options);
  const std::string output = options.output.empty() ? options.folder : options.output;
  if (!options.export_ids.empty()) {
    const std::filesystem::path folder = std::filesystem::path(output) / "photometry";
    for (const auto& file : export_stars(options.folder, options.export_ids, folder)) fmt::print("{}\n", file.string());
    return 0;
  }
  if (!options.output.empty() && std::filesystem::exists(output) && !options.overwrite)
    throw InputError(
        Problem{.file = output, .expected = "another -o DIR, or --overwrite", .message = "the folder exists"});
  const AssessResult result =
      analyse_run(options.folder, {.overrides = options.set, .data_folders = data_folders()}, output);
  for (const std::string& line : result.verdict) fmt::print("{}\n", line);
  fmt::print("Report: {}\n", result.report.string());
  return 0;
}

}  // namespace astroid::commands
