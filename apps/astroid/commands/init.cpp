#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "commands/commands.hpp"
#include "commands/configuration.hpp"

namespace astroid::commands {

int init(const std::string& mission, const std::string& output, bool overwrite) {
  const std::vector<std::string> names = mission_names();
  if (std::find(names.begin(), names.end(), mission) == names.end())
    throw InputError(Problem{.parameter = "MISSION",
                             .value = mission,
                             .expected = fmt::format("one of {}", fmt::join(names, ", ")),
                             .message = "there is no such mission preset"});
  const std::filesystem::path file = output.empty() ? mission + ".xml" : output;
  if (std::filesystem::exists(file) && !overwrite)
    throw InputError(
        Problem{.file = file.string(), .expected = "another name, or --overwrite", .message = "the file exists"});
  write_text_file(file, read_text_file(find_configuration(mission)));
  fmt::print("{}\nEdit it, then: astroid plan {}; astroid assess {} -o DIR\n", file.string(), file.string(),
             file.string());
  return 0;
}

}  // namespace astroid::commands
