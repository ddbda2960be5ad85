#include "commands/configuration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "astroid/core/error.hpp"

namespace astroid::commands {

namespace {

std::filesystem::path program_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : program.parent_path();
}

/// Where presets lie within a data folder: installed, or in the source tree.
const std::vector<std::string>& mission_folders() {
  static const std::vector<std::string> folders{"missions", "apps/missions"};
  return folders;
}

}  // namespace

std::vector<std::filesystem::path> data_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* given = std::getenv("ASTROID_DATA"); given != nullptr && *given != '\0') folders.emplace_back(given);
  const std::filesystem::path program = program_folder();
  if (!program.empty()) folders.push_back(program.parent_path() / "share" / "astroid");
  folders.emplace_back(ASTROID_SOURCE_FOLDER);
  std::erase_if(folders, [](const std::filesystem::path& folder) { return !std::filesystem::is_directory(folder); });
  return folders;
}

std::vector<std::string> mission_names() {
  std::vector<std::string> names;
  for (const auto& folder : data_folders())
    for (const std::string& missions : mission_folders()) {
      std::error_code error;
      for (const auto& entry : std::filesystem::directory_iterator(folder / missions, error))
        if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
    }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::filesystem::path find_configuration(const std::string& name) {
  const bool looks_like_a_path = name.find('/') != std::string::npos || name.ends_with(".xml");
  if (looks_like_a_path || std::filesystem::is_regular_file(name)) return name;
  for (const auto& folder : data_folders())
    for (const std::string& missions : mission_folders()) {
      std::filesystem::path preset = folder / missions / (name + ".xml");
      if (std::filesystem::exists(preset)) return preset;
    }
  throw InputError(
      Problem{.file = name,
              .expected = fmt::format("a file, or one of the presets {}", fmt::join(mission_names(), ", ")),
              .message = "there is no such configuration"});
}

void require_files(const std::vector<std::string>& files) {
  std::vector<Problem> problems;
  for (const std::string& file : files)
    if (!std::filesystem::is_regular_file(file))
      problems.push_back({.file = file,
                          .expected = "the name of a readable file",
                          .message = std::filesystem::exists(file) ? "is not a file" : "there is no such file"});
  if (!problems.empty()) throw InputError(std::move(problems));
}

ResolvedConfiguration read(const ConfigurationOptions& options, std::vector<std::string> more) {
  ConfigurationSurroundings surroundings{.overrides = options.set, .data_folders = data_folders()};
  if (options.seed) surroundings.overrides.push_back(fmt::format("Simulation/Seed={}", *options.seed));
  for (std::string& set : more) surroundings.overrides.push_back(std::move(set));
  return read_configuration(find_configuration(options.configuration), surroundings);
}

}  // namespace astroid::commands
