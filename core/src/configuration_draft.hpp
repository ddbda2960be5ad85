// A configuration while it is being read: what was given and where, and what is wrong so far.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "astroid/core/error.hpp"
#include "configuration_parameter.hpp"
#include "configuration_xml.hpp"

namespace astroid::configuration {

/// The name that stands for a file in problems and origins of overrides.
inline constexpr std::string_view kOverrideOrigin = "--set";

/// A parameter that was given, with a good value.
struct Given {
  Value value;
  std::string file;
  long line = 0;
  std::string as_written;
};

struct Draft {
  std::string file;                            ///< name of the configuration file, as problems show it
  std::vector<std::filesystem::path> folders;  ///< where its files are looked for
  std::map<std::string, Given, std::less<>> given;
  std::map<std::string, long, std::less<>> elements;  ///< path -> line of its first appearance; root: ""
  std::set<std::string, std::less<>> bad;             ///< parameters already complained about
  std::vector<Problem> problems;
};

/// Walks the document: fills `given`, `elements`, `bad`, `problems`.
void read_document(const XmlElement& root, Draft& draft);

/// Applies "Path=value unit" texts in order.
void read_overrides(const ConfigurationSurroundings& surroundings, Draft& draft);

/// Defaults for what is missing, problems for what is missing and required.
void fill_defaults(Draft& draft);

/// What parameters demand of each other; of those already complained about nothing more is said.
void check_together(const Mission& mission, Draft& draft);

/// "did you mean Gain?", "ReadoutNoise belongs in CCD", or empty. Remembers a suggested parameter in draft.bad,
/// so that it isn't reported as missing as well.
std::string suggest_element(std::string_view name, std::string_view section, Draft& draft);
std::string suggest_attribute(std::string_view name, std::string_view element, Draft& draft);
std::string suggest_path(std::string_view path);

}  // namespace astroid::configuration
