#include "html.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "astroid/core/error.hpp"

namespace astroid::html {

namespace {

/// Length of the valid UTF-8 sequence at the beginning of `text`, 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto continued = [&](std::size_t i) { return i < text.size() && (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return continued(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {
    if (!continued(1) || !continued(2)) return 0;
    if (first == 0xE0U && byte(1) < 0xA0U) return 0;  // overlong
    if (first == 0xEDU && byte(1) > 0x9FU) return 0;  // surrogate
    return 3;
  }
  if (first >= 0xF0U && first <= 0xF4U) {
    if (!continued(1) || !continued(2) || !continued(3)) return 0;
    if (first == 0xF0U && byte(1) < 0x90U) return 0;
    if (first == 0xF4U && byte(1) > 0x8FU) return 0;  // beyond U+10FFFF
    return 4;
  }
  return 0;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0U;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    out += kDigits[three >> 18 & 63U];
    out += kDigits[three >> 12 & 63U];
    out += i + 1 < bytes.size() ? kDigits[three >> 6 & 63U] : '=';
    out += i + 2 < bytes.size() ? kDigits[three & 63U] : '=';
  }
  return out;
}

}  // namespace

std::string escape(std::string_view text) {
  constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0) {
      out += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    if (length == 1) {
      switch (c) {
        case '&':
          out += "&amp;";
          break;
        case '<':
          out += "&lt;";
          break;
        case '>':
          out += "&gt;";
          break;
        case '"':
          out += "&quot;";
          break;
        case '\'':
          out += "&#39;";
          break;
        default:
          if ((static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t') || c == 0x7F) {
            out += kReplacement;
          } else {
            out += c;
          }
      }
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return out;
}

std::string data_uri(const std::filesystem::path& file, const std::string& type) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw EnvironmentError(file.string(), "cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return "data:" + type + ";base64," + base64(bytes);
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  constexpr double kPlainFrom = 1e-4;
  constexpr double kPlainTo = 1e6;
  const double size = std::abs(value);
  if (size < kPlainFrom || size >= kPlainTo) {
    const int power = static_cast<int>(std::floor(std::log10(size)));
    return fmt::format("{:.{}g}×10<sup>{}</sup>", value / std::pow(10.0, power), digits, power);
  }
  const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
  return fmt::format("{:.{}f}", value, std::max(0, digits - before));
}

std::string fixed(double value, int decimals, bool sign) {
  if (!std::isfinite(value)) return "–";
  std::string text = sign ? fmt::format("{:+.{}f}", value, decimals) : fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_of("123456789") == std::string::npos) text = fmt::format("{:.{}f}", 0.0, decimals);
  return text[0] == '-' ? "−" + text.substr(1) : text;
}

std::string table(const std::vector<TableColumn>& columns, const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (const TableColumn& column : columns) {
    out += fmt::format("<th{} scope=\"col\">{}{}</th>", column.text ? " class=\"text\"" : "", column.heading,
                       column.unit.empty() ? "" : fmt::format(" <span class=\"unit\">{}</span>", column.unit));
  }
  out += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    ASTROID_CHECK_EQ(row.size(), columns.size());
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      out += fmt::format("<td{}>{}</td>", columns[i].text ? " class=\"text\"" : "", row[i]);
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string section(const std::string& anchor, const std::string& heading, const std::string& body) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", anchor, heading, body);
}

std::string links(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out;
  for (const auto& [text, address] : files) {
    out += fmt::format("{}<a href=\"{}\">{}</a>", out.empty() ? "" : " · ", escape(address), escape(text));
  }
  return out;
}

}  // namespace astroid::html
