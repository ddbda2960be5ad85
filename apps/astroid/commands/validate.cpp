#include <fmt/format.h>

#include "astroid/core/configuration.hpp"
#include "astroid/core/error.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

int validate(const ConfigurationOptions& options, bool schema) {
  if (schema) {
    fmt::print("{}", generate_xsd());
    return 0;
  }
  if (options.configuration.empty())
    throw InputError(Problem{.parameter = "CONFIG",
                             .expected = "a configuration file, the name of a preset, or --schema",
                             .message = "nothing to validate"});
  const ResolvedConfiguration configuration = read(options);
  std::size_t defaults = 0;
  for (const ResolvedParameter& parameter : configuration.parameters) defaults += parameter.origin == "default" ? 1 : 0;
  fmt::print("{}: valid; {} parameters, {} of them defaults\n", find_configuration(options.configuration).string(),
             configuration.parameters.size(), defaults);
  return 0;
}

}  // namespace astroid::commands
