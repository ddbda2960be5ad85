// Reads, checks, writes and explains the XML configuration. One table of parameters is behind all of it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/mission.hpp"

namespace astroid {

/// One parameter as a run uses it.
struct ResolvedParameter {
  std::string path;    ///< "CCD/ReadoutNoise"; attributes are addressed like children: "Telescope/ZeroPoint/passband"
  std::string value;   ///< in `unit`, in the shortest form that reads back to the same number; files as absolute paths
  std::string unit;    ///< the documented unit, empty where the parameter has none
  std::string origin;  ///< "plato.xml:12", "default" or "--set"

  friend bool operator==(const ResolvedParameter&, const ResolvedParameter&) = default;
};

/// A configuration without problems: the values for the physics, and where each came from.
struct ResolvedConfiguration {
  Mission mission;
  std::vector<ResolvedParameter> parameters;  ///< in the order of the reference page; optional ones only where given
};

/// What surrounds the configuration file.
struct ConfigurationSurroundings {
  /// "Path/To/Parameter=value", the value optionally followed by a unit; the last of several for one parameter counts.
  std::vector<std::string> overrides;
  /// Where files named in the configuration are looked for after the configuration's own folder
  /// (files named in an override: first in the current folder).
  std::vector<std::filesystem::path> data_folders;
};

/// Reads and checks a configuration file.
///
/// Everything is checked: names (with suggestions), duplicates, numbers, units, ranges, choices, files, and what
/// parameters demand of each other. A missing parameter takes its documented default.
///
/// @throws InputError with every problem of the file and of the overrides, ordered by line. Text that is not
///         well-formed XML is reported alone, since nothing after it can be trusted. A DOCTYPE is refused, so there
///         are no entities to expand and nothing is ever fetched.
[[nodiscard]] ResolvedConfiguration read_configuration(const std::filesystem::path& file,
                                                       const ConfigurationSurroundings& surroundings = {});

/// The same for a text in memory. `name` stands for the file in messages and origins; files are looked for in `folder`.
[[nodiscard]] ResolvedConfiguration read_configuration_text(std::string_view xml, const std::string& name,
                                                            const std::filesystem::path& folder,
                                                            const ConfigurationSurroundings& surroundings = {});

/// The product config.xml: every parameter as used, each with its origin as an attribute that readers ignore.
/// Reads back to an equal Mission.
[[nodiscard]] std::string to_xml(const ResolvedConfiguration& configuration);

/// A schema (XSD 1.0) for editors and xmllint. It accepts every valid configuration; of what it cannot express
/// (ranges in alternative units, files, checks between parameters) only the reader reports the errors.
[[nodiscard]] std::string generate_xsd();

/// What a parameter means, its unit, range, default and choices, and how to write it.
///
/// @param name  a path ("CCD/Gain"), a section ("CCD"), the last part of a path ("Gain", every match is explained),
///              in any case of letters, or empty for a list of all parameters.
/// @throws InputError for an unknown name, with the nearest known one.
[[nodiscard]] std::string explain(std::string_view name);

/// The page docs/configuration.md (Markdown).
[[nodiscard]] std::string reference_page_markdown();

}  // namespace astroid
