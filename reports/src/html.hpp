// The few pieces of HTML that the report is made of. Every text goes through escape().
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace astroid::html {

/// Text that may stand anywhere in a page or in a double-quoted attribute: markup is escaped; control characters and
/// bytes that are not UTF-8 become U+FFFD.
std::string escape(std::string_view text);

/// `data:` URI of a file. @param type  "image/png"  @throws EnvironmentError
std::string data_uri(const std::filesystem::path& file, const std::string& type);

/// A number with so many significant digits, in the plainest form; an en dash when it is not finite.
std::string number(double value, int digits);
/// The same with so many decimals and, if asked, its sign.
std::string fixed(double value, int decimals, bool sign = false);

struct TableColumn {
  std::string heading;
  std::string unit;
  bool text = false;  ///< left-aligned
};
/// A table in a box that scrolls sideways on a narrow screen. Cells are HTML.
std::string table(const std::vector<TableColumn>& columns, const std::vector<std::vector<std::string>>& rows);

/// <section> with a heading and an anchor.
std::string section(const std::string& anchor, const std::string& heading, const std::string& body);

/// A list of files: "CSV · gnuplot". Pairs of text and relative address.
std::string links(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace astroid::html
