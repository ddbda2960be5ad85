#include <fmt/format.h>

#include "astroid/pipeline/run.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"
#include "commands/console.hpp"
#include "commands/run_options.hpp"

namespace astroid::commands {

int simulate(const AssessOptions& options) {
  const ResolvedConfiguration configuration = read(options.configuration, dump_override(options));
  const StreamResult result = astroid::simulate(configuration, run_options(options, "Exposures"));
  if (options.run.verbose) print_timings(result.timings);
  fmt::print("{} image files in {}/images, truth in {}/truth/stars.csv\n", result.images_written, options.run.folder,
             options.run.folder);
  return 0;
}

}  // namespace astroid::commands
