// How commands find and read a configuration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "commands/commands.hpp"

namespace astroid::commands {

/// Folders in which presets and shipped catalogues are looked for: $ASTROID_DATA, beside the program, the source tree.
std::vector<std::filesystem::path> data_folders();

/// Names of the mission presets that are found.
std::vector<std::string> mission_names();

/// The file a user means: a path, or the name of a preset. @throws InputError that lists the presets
std::filesystem::path find_configuration(const std::string& name);

/// Reads a configuration with the overrides of the command line. @throws InputError with every problem
ResolvedConfiguration read(const ConfigurationOptions& options, std::vector<std::string> more = {});

/// Checks that files named on the command line are there. @throws InputError with every one that is not
void require_files(const std::vector<std::string>& files);

}  // namespace astroid::commands
