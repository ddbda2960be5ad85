// XML text -> a plain tree, without libxml2's types and without its ways of fetching and expanding things.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace astroid::configuration {

struct XmlAttribute {
  std::string name;
  std::string value;
};

struct XmlElement {
  std::string name;
  long line = 0;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  std::string text;  ///< all its direct text, without blanks at the ends
};

/// Parses a document; comments and processing instructions are skipped, attributes of the XMLSchema-instance
/// namespace too.
///
/// @param name  of the file, for messages.
/// @throws InputError with one problem and its line: text that is not well-formed, or a DOCTYPE.
XmlElement parse_xml(std::string_view text, const std::string& name);

/// `text` with &, <, > and quotes escaped.
std::string xml_escaped(std::string_view text);

}  // namespace astroid::configuration
