// Tables as text: a strict writer and a tolerant reader.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"

namespace astroid {

/// The shortest decimal that reads back as the same number: "0.1", "1e+22", "nan", "inf", "-inf"; no locale.
[[nodiscard]] std::string shortest_text(double value);

/// The number that the whole of `text` (blanks around it allowed) stands for; "nan" and "inf" are numbers.
/// Nothing when it is not a number, or one that a double cannot hold (1e999).
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The integer that the whole of `text` (blanks around it allowed) stands for, or nothing.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);

/// Writes a CSV file: a header line, then rows. Numbers are shortest_text(), missing ones `nan`, flags 0 or 1; cells
/// with a comma, quote, '#' or outer blank are quoted; line breaks and NUL inside a cell become blanks. Line ends are
/// \n.
///
/// The file appears under its name at commit(); without it nothing stays behind.
/// @throws EnvironmentError(path, cause), from every member function.  @thread one thread at a time
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);

  /// Writes one row; the number of cells must be that of the columns (BugError).
  template <class... Cells>
  void row(const Cells&... cells) {
    (cell(cells), ...);
    end_row();
  }
  void cell(double value);
  void cell(float value);  ///< shortest text that reads back as the same float
  void cell(std::string_view text);
  void cell(const std::string& text) { cell(std::string_view(text)); }
  void cell(const char* text) { cell(std::string_view(text)); }
  template <std::integral Integer>
  void cell(Integer value) {
    if constexpr (std::unsigned_integral<Integer>) {
      unsigned_cell(value);
    } else {
      signed_cell(value);
    }
  }
  void end_row();
  void commit();

 private:
  void signed_cell(std::int64_t value);
  void unsigned_cell(std::uint64_t value);
  void separate();

  AtomicFile file_;
  std::size_t columns_;
  std::size_t cells_in_row_ = 0;
};

enum class CsvSeparator { kAuto, kComma, kSemicolon, kTab, kBlanks };
enum class CsvHeader {
  kAuto,     ///< the first line is a header unless every field of it is a number
  kPresent,  ///< the first line is a header
  kAbsent,   ///< the first line is data
};

struct CsvOptions {
  CsvSeparator separator =
      CsvSeparator::kAuto;  ///< kAuto: the first of , TAB ; that stands in the first line, else blanks
  CsvHeader header = CsvHeader::kAuto;
};

/// A table read from text. Fields are views on the text that the table owns; copies share it.  @thread safe (immutable)
class CsvTable {
 public:
  struct Comment {
    long line;              ///< 1-based
    std::string_view text;  ///< without the leading '#' and blanks
  };

  [[nodiscard]] const std::string& file() const { return file_; }
  /// Names of the columns, or empty when the file has no header line.
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  [[nodiscard]] long header_line() const { return header_line_; }  ///< 1-based; 0 without a header
  [[nodiscard]] const std::vector<Comment>& comments() const { return comments_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return lines_.size(); }
  [[nodiscard]] long line(std::size_t row) const { return lines_[row]; }  ///< 1-based line of the file
  [[nodiscard]] std::string_view field(std::size_t row, std::size_t column) const {
    return fields_[row * columns_ + column];
  }
  /// parse_number() of a field.
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column) const;
  /// The column of that name: exactly, else the first that differs in case only, else nothing.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// A Problem about one field: file, line, column and value are filled in.
  [[nodiscard]] Problem problem(std::size_t row, std::size_t column, const std::string& message,
                                const std::string& expected = {}) const;

 private:
  friend class CsvParser;
  std::string file_;
  std::shared_ptr<std::string> text_;
  std::vector<std::string> header_;
  long header_line_ = 0;
  std::vector<Comment> comments_;
  std::size_t columns_ = 0;
  std::vector<long> lines_;
  std::vector<std::string_view> fields_;
};

/// Reads a table of text: CSV, TSV, blank-separated columns, the body of ECSV.
///
/// Accepts a byte-order mark, any line ends, empty lines, '#' comment lines, blanks around fields, fields in double
/// quotes
/// ("" for a quote; a field ends on its line), and one separator too many at the end of a line.
/// @throws InputError with every problem (the first hundred): empty file, NUL byte, a line longer than 1 MiB, a quote
/// that
///         is not closed, rows with another number of fields than the header or first row. EnvironmentError(path,
///         cause).
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& path, const CsvOptions& options = {});

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] CsvTable parse_csv(std::string text, const std::string& name, const CsvOptions& options = {});

}  // namespace astroid
