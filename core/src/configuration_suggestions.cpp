#include <fmt/format.h>
#include <fmt/ranges.h>

#include "configuration_draft.hpp"
#include "configuration_names.hpp"

namespace astroid::configuration {

namespace {

/// Sections in which an element of this name may stand, as they are called in messages.
std::vector<std::string> homes_of(std::string_view name) {
  std::vector<std::string> homes;
  for (const Parameter& parameter : parameter_table()) {
    for (std::string_view path = parameter.path; !path.empty(); path = parent_path(path)) {
      const bool is_element = !(parameter.is_attribute && path.size() == parameter.path.size());
      const std::string home(parent_path(path).empty() ? "Astroid" : parent_path(path));
      if (!is_element || last_name(path) != name) continue;
      if (homes.empty() || homes.back() != home) homes.push_back(home);
    }
  }
  return homes;
}

std::vector<std::string> all_paths() {
  std::vector<std::string> paths;
  for (const Parameter& parameter : parameter_table()) paths.emplace_back(parameter.path);
  return paths;
}

}  // namespace

std::string suggest_element(std::string_view name, std::string_view section, Draft& draft) {
  const std::vector<std::string> names = element_names(section);
  const std::vector<std::string> homes = homes_of(name);
  if (!homes.empty()) return fmt::format("{} belongs in {}", name, fmt::join(homes, " or "));
  for (const std::string& attribute : attribute_names(section)) {
    if (!equal_ignoring_case(attribute, name)) continue;
    draft.bad.insert(join_path(section, attribute));
    return fmt::format("write it as an attribute: <{} {}=\"...\">", last_name(section), attribute);
  }
  const std::string near = nearest_name(name, names);
  if (!near.empty()) {
    draft.bad.insert(join_path(section, near));
    return fmt::format("did you mean {}?", near);
  }
  std::vector<std::string> elsewhere;
  for (const std::string& path : all_paths()) elsewhere.emplace_back(last_name(path));
  const std::string distant = nearest_name(name, elsewhere);
  for (const std::string& path : all_paths()) {
    if (!distant.empty() && last_name(path) == distant) return fmt::format("did you mean {}?", path);
  }
  return {};
}

std::string suggest_attribute(std::string_view name, std::string_view element, Draft& draft) {
  for (const std::string& child : element_names(element)) {
    if (!equal_ignoring_case(child, name)) continue;
    draft.bad.insert(join_path(element, child));
    return fmt::format("write it as an element <{0}> inside {1}", child, last_name(element));
  }
  std::vector<std::string> names = attribute_names(element);
  const Parameter* parameter = find_parameter(element);
  if (parameter != nullptr && !parameter->unit.empty()) names.emplace_back("unit");
  const std::string near = nearest_name(name, names);
  if (near.empty()) return {};
  draft.bad.insert(join_path(element, near));
  return fmt::format("did you mean {}?", near);
}

std::string suggest_path(std::string_view path) {
  const std::vector<std::string> paths = all_paths();
  for (const std::string& candidate : paths) {
    if (equal_ignoring_case(candidate, path)) return fmt::format("did you mean {}?", candidate);
  }
  std::vector<std::string> same_name;
  std::vector<std::string> names;
  for (const std::string& candidate : paths) {
    names.emplace_back(last_name(candidate));
    if (equal_ignoring_case(names.back(), last_name(path))) same_name.push_back(candidate);
  }
  if (!same_name.empty()) return fmt::format("did you mean {}?", fmt::join(same_name, " or "));
  const std::string near = nearest_name(path, paths);
  if (!near.empty()) return fmt::format("did you mean {}?", near);
  const std::string near_name = nearest_name(last_name(path), names);
  for (const std::string& candidate : paths) {
    if (!near_name.empty() && last_name(candidate) == near_name) return fmt::format("did you mean {}?", candidate);
  }
  return {};
}

}  // namespace astroid::configuration
