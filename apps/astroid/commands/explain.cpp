#include <fmt/format.h>

#include "astroid/core/configuration.hpp"
#include "commands/commands.hpp"

namespace astroid::commands {

int explain(const std::string& parameter) {
  fmt::print("{}", astroid::explain(parameter));
  return 0;
}

}  // namespace astroid::commands
