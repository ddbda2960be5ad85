#include <fmt/format.h>

#include "astroid/pipeline/run.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

int plan(const PlanOptions& options) {
  const PreparedRun run = prepare_run(read(options.configuration).mission);
  fmt::print("{}", options.json ? plan_json(run) : plan_text(run));
  return 0;
}

}  // namespace astroid::commands
