// What assess and simulate make of their options.
#pragma once

#include <string>
#include <vector>

#include "astroid/pipeline/run.hpp"
#include "commands/commands.hpp"

namespace astroid::commands {

RunOptions run_options(const AssessOptions& options, const std::string& progress);

/// --dump-steps as an override of Output/DumpSteps, so that config.xml tells of it.
std::vector<std::string> dump_override(const AssessOptions& options);

/// Where the time of a stream went, on standard error.
void print_timings(const StreamTimings& timings);

}  // namespace astroid::commands
