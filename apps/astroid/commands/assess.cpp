#include <fmt/format.h>

#include "astroid/pipeline/run.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/console.hpp"
#include "commands/run_options.hpp"

namespace astroid::commands {

int assess(const AssessOptions& options) {
  const ResolvedConfiguration configuration = read(options.configuration, dump_override(options));
  const AssessResult result = astroid::assess(configuration, run_options(options, "Exposures"));
  if (options.run.verbose) print_timings(result.timings);
  for (const std::string& line : result.verdict) fmt::print("{}\n", line);
  fmt::print("Report: {}\n", result.report.string());
  return 0;
}

}  // namespace astroid::commands
