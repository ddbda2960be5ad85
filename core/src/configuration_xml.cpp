#include "configuration_xml.hpp"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <libxml/tree.h>

#include <memory>

#include "astroid/core/error.hpp"
#include "configuration_value.hpp"

namespace astroid::configuration {

namespace {

constexpr std::size_t kLargestFile = 16U << 20U;  // bytes; a configuration has a few thousand

struct ContextDeleter {
  void operator()(xmlParserCtxt* context) const {
    if (context->myDoc != nullptr) xmlFreeDoc(context->myDoc);
    context->myDoc = nullptr;
    xmlFreeParserCtxt(context);
  }
};

/// What the parser met, collected by its callbacks.
struct Findings {
  std::string message;  ///< of the first fatal error
  long line = 0;
  bool has_doctype = false;
};

std::string as_string(const xmlChar* text) {
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

void on_error(void* user_data, xmlErrorPtr error) {
  auto& findings = *static_cast<Findings*>(static_cast<xmlParserCtxt*>(user_data)->_private);
  if (error == nullptr || error->level < XML_ERR_ERROR || !findings.message.empty()) return;
  const std::string_view text = error->message == nullptr ? "unknown error" : trimmed(error->message);
  findings.message = std::string(text.substr(0, text.find('\n')));
  findings.line = error->line;
}

/// Stops before anything that a DOCTYPE declares is read: no entity is ever defined, let alone expanded or fetched.
void on_doctype(void* user_data, const xmlChar*, const xmlChar*, const xmlChar*) {
  auto* context = static_cast<xmlParserCtxt*>(user_data);
  auto& findings = *static_cast<Findings*>(context->_private);
  findings.has_doctype = true;
  findings.line = xmlSAX2GetLineNumber(context);
  xmlStopParser(context);
}

std::string qualified_name(const xmlNs* space, const xmlChar* name) {
  std::string text = as_string(name);
  if (space != nullptr && space->prefix != nullptr) text = as_string(space->prefix) + ":" + text;
  return text;
}

std::string attribute_value(xmlAttr* attribute) {
  const std::unique_ptr<xmlChar, void (*)(void*)> value(xmlNodeListGetString(attribute->doc, attribute->children, 1),
                                                        [](void* text) { xmlFree(text); });
  return as_string(value.get());
}

XmlElement convert(xmlNode* node) {
  constexpr std::string_view kSchemaInstance = "http://www.w3.org/2001/XMLSchema-instance";
  XmlElement element;
  element.name = qualified_name(node->ns, node->name);
  element.line = xmlGetLineNo(node);
  for (xmlAttr* attribute = node->properties; attribute != nullptr; attribute = attribute->next) {
    if (attribute->ns != nullptr && as_string(attribute->ns->href) == kSchemaInstance) continue;
    element.attributes.push_back({qualified_name(attribute->ns, attribute->name), attribute_value(attribute)});
  }
  std::string text;
  for (xmlNode* child = node->children; child != nullptr; child = child->next) {
    if (child->type == XML_ELEMENT_NODE) element.children.push_back(convert(child));
    if (child->type == XML_TEXT_NODE || child->type == XML_CDATA_SECTION_NODE) text += as_string(child->content);
  }
  element.text = std::string(trimmed(text));
  return element;
}

InputError document_problem(const std::string& name, long line, std::string message) {
  return InputError(Problem{.file = name, .line = line, .message = std::move(message)});
}

}  // namespace

XmlElement parse_xml(std::string_view text, const std::string& name) {
  [[maybe_unused]] static const bool initialised = (xmlInitParser(), true);
  if (trimmed(text).empty()) throw document_problem(name, 0, "the file is empty");
  if (text.size() > kLargestFile) throw document_problem(name, 0, "too large for a configuration (more than 16 MiB)");

  const std::unique_ptr<xmlParserCtxt, ContextDeleter> context(
      xmlCreateMemoryParserCtxt(text.data(), static_cast<int>(text.size())));
  if (!context) throw document_problem(name, 0, "cannot be read as XML");
  Findings findings;
  xmlCtxtUseOptions(context.get(), XML_PARSE_NONET | XML_PARSE_BIG_LINES | XML_PARSE_NOWARNING);
  context->_private = &findings;
  context->sax->serror = on_error;
  context->sax->initialized = XML_SAX2_MAGIC;
  context->sax->internalSubset = on_doctype;
  context->userData = context.get();
  xmlParseDocument(context.get());

  if (findings.has_doctype) throw document_problem(name, findings.line, "a DOCTYPE is not allowed: remove it");
  if (context->wellFormed == 0 || !findings.message.empty()) {
    throw document_problem(name, findings.line, fmt::format("not well-formed XML: {}", findings.message));
  }
  xmlNode* root = context->myDoc == nullptr ? nullptr : xmlDocGetRootElement(context->myDoc);
  if (root == nullptr) throw document_problem(name, 0, "has no XML element");
  return convert(root);
}

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\n':
        escaped += "&#10;";
        break;
      case '\t':
        escaped += "&#9;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace astroid::configuration
