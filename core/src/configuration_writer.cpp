#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>

#include "astroid/core/configuration.hpp"
#include "configuration_parameter.hpp"
#include "configuration_xml.hpp"

namespace astroid {

namespace {

using configuration::xml_escaped;

constexpr int kIndent = 2;

/// Writes the elements of a configuration, sections recursively, in the order of the table.
class Writer {
 public:
  explicit Writer(const ResolvedConfiguration& configuration) {
    for (const ResolvedParameter& parameter : configuration.parameters) by_path_.emplace(parameter.path, &parameter);
  }

  [[nodiscard]] std::string document() {
    out_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Astroid version=\"1\">\n";
    for (const std::string& section : configuration::element_names("")) write_section(section, 1);
    return out_ + "</Astroid>\n";
  }

 private:
  [[nodiscard]] const ResolvedParameter* find(std::string_view path) const {
    const auto found = by_path_.find(path);
    return found == by_path_.end() ? nullptr : found->second;
  }

  /// Its attributes, last their common origin or the origin of each: `passband="P" origin="a.xml:3; passband:
  /// default"`.
  [[nodiscard]] std::string attributes(std::string_view path, const ResolvedParameter* element) const {
    std::string text;
    std::string origin = element == nullptr ? std::string() : element->origin;
    std::string own_origins;
    if (element != nullptr && !element->unit.empty()) text += fmt::format(" unit=\"{}\"", xml_escaped(element->unit));
    for (const std::string& name : configuration::attribute_names(path)) {
      const ResolvedParameter* attribute = find(configuration::join_path(path, name));
      if (attribute == nullptr) continue;
      text += fmt::format(" {}=\"{}\"", name, xml_escaped(attribute->value));
      if (origin.empty()) origin = attribute->origin;
      if (attribute->origin != origin) own_origins += fmt::format("; {}: {}", name, attribute->origin);
    }
    if (!origin.empty()) text += fmt::format(" origin=\"{}\"", xml_escaped(origin + own_origins));
    return text;
  }

  void write_section(const std::string& path, int depth) {
    const std::string indent(static_cast<std::size_t>(kIndent * depth), ' ');
    const std::string_view name = configuration::last_name(path);
    const std::string own = attributes(path, nullptr);
    const std::size_t start = out_.size();
    for (const std::string& child : configuration::element_names(path)) {
      const std::string child_path = configuration::join_path(path, child);
      if (configuration::is_section(child_path)) {
        write_section(child_path, depth + 1);
      } else if (const ResolvedParameter* parameter = find(child_path)) {
        out_ += fmt::format("{0:{1}}<{2}{3}>{4}</{2}>\n", "", kIndent * (depth + 1), child,
                            attributes(child_path, parameter), xml_escaped(parameter->value));
      }
    }
    if (out_.size() > start) {
      out_.insert(start, fmt::format("{}<{}{}>\n", indent, name, own));
      out_ += fmt::format("{}</{}>\n", indent, name);
    } else if (!own.empty()) {
      out_ += fmt::format("{}<{}{}/>\n", indent, name, own);
    }
  }

  std::map<std::string, const ResolvedParameter*, std::less<>> by_path_;
  std::string out_;
};

}  // namespace

std::string to_xml(const ResolvedConfiguration& configuration) {
  return Writer(configuration).document();
}

}  // namespace astroid
