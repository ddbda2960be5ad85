#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "astroid/core/configuration.hpp"
#include "astroid/core/error.hpp"
#include "configuration_draft.hpp"

namespace astroid {

namespace {

using configuration::Draft;
using configuration::Given;
using configuration::Parameter;

Mission assemble(const Draft& draft) {
  Mission mission;
  for (const Parameter& parameter : configuration::parameter_table()) {
    const auto given = draft.given.find(parameter.path);
    if (given != draft.given.end()) parameter.assign(mission, given->second.value);
  }
  return mission;
}

std::string origin(const Given& given) {
  if (given.file.empty()) return "default";
  return given.line > 0 ? fmt::format("{}:{}", given.file, given.line) : given.file;
}

std::vector<ResolvedParameter> resolved_parameters(const Draft& draft) {
  std::vector<ResolvedParameter> resolved;
  for (const Parameter& parameter : configuration::parameter_table()) {
    const auto given = draft.given.find(parameter.path);
    if (given == draft.given.end()) continue;
    resolved.push_back(
        {std::string(parameter.path), given->second.value.text, std::string(parameter.unit), origin(given->second)});
  }
  return resolved;
}

/// By line, the overrides last.
void sort_problems(std::vector<Problem>& problems) {
  const auto key = [](const Problem& p) { return std::pair(p.file == configuration::kOverrideOrigin, p.line); };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return key(a) < key(b); });
}

}  // namespace

ResolvedConfiguration read_configuration_text(std::string_view xml, const std::string& name,
                                              const std::filesystem::path& folder,
                                              const ConfigurationSurroundings& surroundings) {
  Draft draft;
  draft.file = name;
  draft.folders = {folder};
  draft.folders.insert(draft.folders.end(), surroundings.data_folders.begin(), surroundings.data_folders.end());
  configuration::read_document(configuration::parse_xml(xml, name), draft);
  if (!draft.elements.empty()) {  // without the right root nothing else can be judged
    configuration::read_overrides(surroundings, draft);
    configuration::fill_defaults(draft);
  }
  Mission mission = assemble(draft);
  mission.simulation.start_mjd += mission.simulation.quarter * mission.satellite.quarter_days;
  if (!draft.elements.empty()) configuration::check_together(mission, draft);
  if (!draft.problems.empty()) {
    sort_problems(draft.problems);
    throw InputError(std::move(draft.problems));
  }
  return {mission, resolved_parameters(draft)};
}

ResolvedConfiguration read_configuration(const std::filesystem::path& file,
                                         const ConfigurationSurroundings& surroundings) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(Problem{.file = file.string(), .message = "a folder, not a configuration file"});
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream) {
    const int cause = errno;
    throw InputError(Problem{.file = file.string(),
                             .message = fmt::format("cannot be read: {}", std::generic_category().message(cause))});
  }
  return read_configuration_text(text.str(), file.string(), file.parent_path(), surroundings);
}

}  // namespace astroid
