#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "astroid/core/configuration.hpp"
#include "configuration_parameter.hpp"
#include "configuration_units.hpp"
#include "configuration_xml.hpp"

namespace astroid {

namespace {

using configuration::Kind;
using configuration::Parameter;
using configuration::xml_escaped;

// What the reader takes for a number: unlike xs:double no INF and no NaN.
constexpr std::string_view kNumberPattern = R"([+\-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+\-]?[0-9]+)?)";
constexpr std::string_view kTimePattern = R"([0-9]{4}-[0-9]{2}-[0-9]{2}(T[0-9]{2}:[0-9]{2}(:[0-9]{2}(\.[0-9]+)?)?)?)";
constexpr std::string_view kIntegerListPattern = "[0-9+, ]*";
constexpr std::string_view kRealListPattern = R"([0-9+\-.eE, ]*)";

std::string type_name(std::string_view path) {
  std::string name(path);
  std::replace(name.begin(), name.end(), '/', '.');
  return name;
}

std::string facet(std::string_view kind, std::string_view value) {
  return fmt::format("<xs:{} value=\"{}\"/>", kind, xml_escaped(value));
}

std::string restriction(std::string_view base, std::string_view facets) {
  return fmt::format("<xs:restriction base=\"xs:{}\">{}</xs:restriction>", base, facets);
}

std::string union_of(std::string_view first, std::string_view second) {
  return fmt::format("<xs:union><xs:simpleType>{}</xs:simpleType><xs:simpleType>{}</xs:simpleType></xs:union>", first,
                     second);
}

/// Bounds as facets. With alternative units only the sign survives: the schema can't tie a range to an attribute.
std::string bounds(const Parameter& parameter) {
  const configuration::Range& range = parameter.range;
  const bool scales = configuration::accepted_units(parameter.unit).size() > 1;
  std::string facets;
  if (scales) {
    if (range.minimum > 0 || (range.minimum == 0 && range.minimum_is_open)) return facet("minExclusive", "0");
    return range.minimum == 0 ? facet("minInclusive", "0") : "";
  }
  if (std::isfinite(range.minimum)) {
    facets += facet(range.minimum_is_open ? "minExclusive" : "minInclusive", fmt::format("{}", range.minimum));
  }
  if (std::isfinite(range.maximum)) {
    const bool whole = parameter.kind == Kind::kInteger;
    facets += facet("maxInclusive",
                    whole ? fmt::format("{:.0f}", std::floor(range.maximum)) : fmt::format("{}", range.maximum));
  }
  return facets;
}

std::string enumeration(const std::vector<std::string_view>& words) {
  std::string facets;
  for (const std::string_view word : words) facets += facet("enumeration", word);
  return restriction("token", facets);
}

std::string choice_type(const Parameter& parameter) {
  std::vector<std::string_view> words;
  std::string counted;
  for (const std::string_view choice : parameter.choices) {
    if (choice.ends_with(configuration::kCountedSuffix)) {
      const std::string_view word = choice.substr(0, choice.size() - configuration::kCountedSuffix.size());
      counted = restriction("token", facet("pattern", fmt::format("{} 0*[1-9][0-9]*", word)));
    } else {
      words.push_back(choice);
    }
  }
  return counted.empty() ? enumeration(words) : union_of(enumeration(words), counted);
}

std::string value_type(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::kReal: {
      const std::string number = restriction("double", bounds(parameter) + facet("pattern", kNumberPattern));
      return parameter.keyword.empty() ? number : union_of(number, enumeration({parameter.keyword}));
    }
    case Kind::kInteger:
      return restriction("integer", bounds(parameter));
    case Kind::kBoolean:
      return enumeration({"on", "off", "true", "false", "yes", "no", "1", "0"});
    case Kind::kChoice:
      return choice_type(parameter);
    case Kind::kTime:
      return restriction("token", facet("pattern", kTimePattern));
    case Kind::kIntegerList:
      return restriction("token", facet("pattern", kIntegerListPattern));
    case Kind::kRealList:
      return restriction("token", facet("pattern", kRealListPattern));
    case Kind::kText:
    case Kind::kFile:
      return restriction("token", facet("minLength", "1"));
  }
  return {};
}

std::string documentation(std::string_view text) {
  return fmt::format("<xs:annotation><xs:documentation>{}</xs:documentation></xs:annotation>", xml_escaped(text));
}

/// The attributes of an element that are parameters, its unit, and the origin that products carry.
std::string attributes(std::string_view path) {
  std::string text;
  for (const std::string& name : configuration::attribute_names(path)) {
    const Parameter& parameter = *configuration::find_parameter(configuration::join_path(path, name));
    text += fmt::format("<xs:attribute name=\"{}\" type=\"{}\" use=\"{}\">{}</xs:attribute>\n", name,
                        type_name(parameter.path), parameter.is_required_in_parent ? "required" : "optional",
                        documentation(parameter.meaning));
  }
  const Parameter* owner = configuration::find_parameter(path);
  if (owner != nullptr && !owner->unit.empty()) {
    text +=
        fmt::format("<xs:attribute name=\"unit\" use=\"required\"><xs:simpleType>{}</xs:simpleType></xs:attribute>\n",
                    enumeration(configuration::accepted_units(owner->unit)));
  }
  return text + "<xs:attribute name=\"origin\" type=\"xs:string\"/>\n";
}

/// True for an element without which a required parameter is missing.
bool must_appear(std::string_view path) {
  const auto table = configuration::parameter_table();
  return std::any_of(table.begin(), table.end(), [&](const Parameter& p) {
    return p.is_required && (p.path == path || p.path.starts_with(fmt::format("{}/", path)));
  });
}

std::string element(const std::string& path) {
  std::string content;
  std::string meaning;
  if (const Parameter* parameter = configuration::find_parameter(path)) {
    meaning = parameter->meaning;
    content = fmt::format("<xs:simpleContent><xs:extension base=\"{}\">\n{}</xs:extension></xs:simpleContent>",
                          type_name(path), attributes(path));
  } else {
    meaning = configuration::section_meaning(path);
    std::string children;
    for (const std::string& name : configuration::element_names(path)) {
      children += element(configuration::join_path(path, name));
    }
    if (!children.empty()) content = fmt::format("<xs:all>\n{}</xs:all>\n", children);
    content += attributes(path);
  }
  return fmt::format("<xs:element name=\"{}\" minOccurs=\"{}\">{}<xs:complexType>{}</xs:complexType></xs:element>\n",
                     configuration::last_name(path), must_appear(path) ? 1 : 0, documentation(meaning), content);
}

}  // namespace

std::string generate_xsd() {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!-- Made from the parameter table of ASTROID. -->\n"
      "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n";
  for (const Parameter& parameter : configuration::parameter_table()) {
    out += fmt::format("<xs:simpleType name=\"{}\">{}</xs:simpleType>\n", type_name(parameter.path),
                       value_type(parameter));
  }
  out += "<xs:element name=\"Astroid\"><xs:complexType><xs:all>\n";
  for (const std::string& name : configuration::element_names("")) out += element(name);
  out +=
      "</xs:all>\n<xs:attribute name=\"version\" use=\"required\" fixed=\"1\"/>\n"
      "<xs:attribute name=\"origin\" type=\"xs:string\"/>\n</xs:complexType></xs:element>\n</xs:schema>\n";
  return out;
}

}  // namespace astroid
