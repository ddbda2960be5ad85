#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "astroid/core/csv.hpp"

namespace astroid {

namespace {

constexpr std::size_t kLongestNumber = 32;  // characters; shortest double: 24, 64-bit integer: 20

template <class Number>
std::string number_text(Number value) {
  std::array<char, kLongestNumber> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) throw BugError("shortest_text: number longer than its buffer");
  return {text.data(), end};
}

bool is_line_break_or_nul(char c) {
  return c == '\n' || c == '\r' || c == '\0';
}

bool needs_quotes(std::string_view text) {
  if (text.empty()) return false;
  return text.find_first_of(",\"#") != std::string_view::npos || text.front() == ' ' || text.front() == '\t' ||
         text.back() == ' ' || text.back() == '\t';
}

std::string cell_text(std::string_view text) {
  std::string clean(text);
  std::replace_if(clean.begin(), clean.end(), is_line_break_or_nul, ' ');
  if (!needs_quotes(clean)) return clean;
  std::string quoted = "\"";
  for (const char c : clean) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string shortest_text(double value) {
  if (std::isnan(value)) return "nan";  // to_chars prints the sign of a NaN, which differs between processors
  return number_text(value);
}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : file_(path), columns_(columns.size()) {
  for (const std::string& name : columns) cell(std::string_view(name));
  end_row();
}

void CsvWriter::separate() {
  if (cells_in_row_++ > 0) file_.write(",");
}

void CsvWriter::cell(double value) {
  separate();
  file_.write(shortest_text(value));
}

void CsvWriter::cell(float value) {
  separate();
  file_.write(std::isnan(value) ? "nan" : number_text(value));
}

void CsvWriter::cell(std::string_view text) {
  separate();
  file_.write(cell_text(text));
}

void CsvWriter::signed_cell(std::int64_t value) {
  separate();
  file_.write(number_text(value));
}

void CsvWriter::unsigned_cell(std::uint64_t value) {
  separate();
  file_.write(number_text(value));
}

void CsvWriter::end_row() {
  ASTROID_CHECK_EQ(cells_in_row_, columns_);
  cells_in_row_ = 0;
  file_.write("\n");
}

void CsvWriter::commit() {
  ASTROID_CHECK_EQ(cells_in_row_, std::size_t{0});
  file_.commit();
}

}  // namespace astroid
