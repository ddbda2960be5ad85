#include "commands/run_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "commands/console.hpp"

namespace astroid::commands {

RunOptions run_options(const AssessOptions& options, const std::string& progress) {
  RunOptions run;
  run.folder = options.run.folder;
  run.existing = options.run.overwrite ? ExistingProducts::kOverwrite : ExistingProducts::kRefuse;
  run.threads = thread_count(options.run.threads);
  run.command_line = options.run.command_line;
  run.progress = progress_bar(progress);
  return run;
}

std::vector<std::string> dump_override(const AssessOptions& options) {
  if (options.dump_steps.empty()) return {};
  return {fmt::format("Output/DumpSteps={}", fmt::join(options.dump_steps, ","))};
}

void print_timings(const StreamTimings& timings) {
  fmt::print(stderr,
             "prepare      {:8.2f} s\nsimulate     {:8.2f} s of CPU\nmeasure      {:8.2f} s of CPU\nimages       "
             "{:8.2f} s of CPU\n"
             "statistics   {:8.2f} s\nlight curves {:8.2f} s\nexposures in {:8.2f} s\n",
             timings.prepare, timings.simulate, timings.measure, timings.images, timings.statistics,
             timings.light_curves, timings.wall);
}

}  // namespace astroid::commands
