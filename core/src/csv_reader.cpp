#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <system_error>
#include <utility>

#include "astroid/core/csv.hpp"

namespace astroid {

namespace {

constexpr std::size_t kLongestLine = std::size_t{1}
                                     << 20U;   // bytes; more is no table of ours, and would flood messages
constexpr std::size_t kMostProblems = 100;     // more of them help nobody
constexpr std::size_t kLongestQuotation = 60;  // characters of a bad value that a message repeats
constexpr std::string_view kBlanks = " \t\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus sign
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string quotation(std::string_view text) {
  return text.size() <= kLongestQuotation ? std::string(text) : std::string(text.substr(0, kLongestQuotation)) + "...";
}

bool holds_only_numbers(std::string_view line) {
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    if (end > 0 && !parse_number(line.substr(0, end))) return false;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return true;
}

CsvSeparator guess_separator(std::string_view line) {
  bool in_quotes = false;
  bool tab = false;
  bool semicolon = false;
  for (const char c : line) {
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == ',') return CsvSeparator::kComma;
    tab = tab || c == '\t';
    semicolon = semicolon || c == ';';
  }
  // Columns of numbers aligned with a mixture of blanks and tabs are no TSV.
  if (tab && !(line.find(' ') != std::string_view::npos && holds_only_numbers(line))) return CsvSeparator::kTab;
  return semicolon ? CsvSeparator::kSemicolon : CsvSeparator::kBlanks;
}

std::string_view characters(CsvSeparator separator) {
  switch (separator) {
    case CsvSeparator::kComma:
      return ",";
    case CsvSeparator::kSemicolon:
      return ";";
    case CsvSeparator::kTab:
      return "\t";
    default:
      return kBlanks;
  }
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  return parse<double>(text);
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse<std::int64_t>(text);
}

std::optional<double> CsvTable::number(std::size_t row, std::size_t column) const {
  return parse_number(field(row, column));
}

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  std::optional<std::size_t> other_case;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (header_[i] == name) return i;
    if (!other_case && equal_but_for_case(header_[i], name)) other_case = i;
  }
  return other_case;
}

Problem CsvTable::problem(std::size_t row, std::size_t column, const std::string& message,
                          const std::string& expected) const {
  const std::string name = header_.empty() ? fmt::format("column {}", column + 1) : "column " + header_[column];
  return Problem{.file = file_,
                 .line = lines_[row],
                 .parameter = name,
                 .value = quotation(field(row, column)),
                 .expected = expected,
                 .message = message};
}

/// Cuts the text of a table into fields, in place.
class CsvParser {
 public:
  CsvParser(std::string text, const std::string& name, const CsvOptions& options) : options_(options) {
    table_.file_ = name;
    table_.text_ = std::make_shared<std::string>(std::move(text));
  }

  CsvTable run() {
    std::string& text = *table_.text_;
    std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    long line = 0;
    while (begin < text.size() && problems_.size() < kMostProblems) {
      const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
      ++line;
      parse_line({text.data() + begin, end - begin}, line);
      begin = text.compare(end, 2, "\r\n") == 0 ? end + 2 : end + 1;
    }
    if (problems_.empty() && table_.columns_ == 0) add_problem(0, "is empty", "a table with at least one line");
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(table_);
  }

 private:
  void add_problem(long line, const std::string& message, const std::string& expected) {
    problems_.push_back(Problem{.file = table_.file_, .line = line, .expected = expected, .message = message});
  }

  void parse_line(std::span<char> line, long number) {
    const std::string_view content = trimmed({line.data(), line.size()});
    if (line.size() > kLongestLine) {
      add_problem(number, fmt::format("the line is {} bytes long", line.size()),
                  fmt::format("lines of at most {} bytes", kLongestLine));
      return;
    }
    if (content.find('\0') != std::string_view::npos) {
      add_problem(number, "contains a NUL byte", "plain text (ASCII or UTF-8)");
      return;
    }
    if (content.empty()) return;
    if (content.front() == '#') {
      table_.comments_.push_back({number, trimmed(content.substr(1))});
      return;
    }
    if (options_.separator == CsvSeparator::kAuto) options_.separator = guess_separator(content);
    if (split(line, number)) accept(number);
  }

  // Cuts one line into row_. Returns false after a problem.
  bool split(std::span<char> line, long number) {
    row_.clear();
    const std::string_view separators = characters(options_.separator);
    const bool by_blanks = options_.separator == CsvSeparator::kBlanks;
    const std::string_view text(line.data(), line.size());
    std::size_t at = 0;
    for (;;) {
      at = std::min(text.find_first_not_of(options_.separator == CsvSeparator::kTab ? " " : kBlanks, at), text.size());
      if (by_blanks && at == text.size()) return true;
      std::size_t end = 0;
      if (at < text.size() && text[at] == '"') {
        const std::optional<std::size_t> closed = unquote(line, at);
        if (!closed) {
          add_problem(number, fmt::format("the quote of field {} is not closed on its line", row_.size() + 1),
                      "a closing \" and \"\" for a quote inside the field");
          return false;
        }
        end = std::min(text.find_first_of(separators, *closed), text.size());
        if (!trimmed(text.substr(*closed, end - *closed)).empty()) {
          add_problem(number, fmt::format("text follows the closing quote of field {}", row_.size()),
                      "a separator, or \"\" for a quote inside the field");
          return false;
        }
      } else {
        end = std::min(text.find_first_of(separators, at), text.size());
        row_.push_back(trimmed(text.substr(at, end - at)));
      }
      if (end == text.size()) return true;
      at = end + 1;
    }
  }

  // Adds the quoted field that begins at `open` to row_, its doubled quotes made single in place.
  // Returns the place after the closing quote, or nothing if there is none.
  std::optional<std::size_t> unquote(std::span<char> line, std::size_t open) {
    std::size_t written = open + 1;
    for (std::size_t i = open + 1; i < line.size(); ++i) {
      if (line[i] == '"') {
        if (i + 1 == line.size() || line[i + 1] != '"') {
          row_.emplace_back(line.data() + open + 1, written - open - 1);
          return i + 1;
        }
        ++i;
      }
      line[written++] = line[i];
    }
    return std::nullopt;
  }

  void accept(long number) {
    if (table_.columns_ == 0) {
      table_.columns_ = row_.size();
      const bool numbers =
          std::all_of(row_.begin(), row_.end(), [](std::string_view f) { return parse_number(f).has_value(); });
      if (options_.header == CsvHeader::kPresent || (options_.header == CsvHeader::kAuto && !numbers)) {
        table_.header_.assign(row_.begin(), row_.end());
        table_.header_line_ = number;
        return;
      }
    }
    if (row_.size() == table_.columns_ + 1 && row_.back().empty()) row_.pop_back();
    if (row_.size() != table_.columns_) {
      add_problem(number, fmt::format("the row has {} field{}", row_.size(), row_.size() == 1 ? "" : "s"),
                  fmt::format("{}, as in the {}", table_.columns_, table_.header_.empty() ? "first row" : "header"));
      return;
    }
    table_.lines_.push_back(number);
    table_.fields_.insert(table_.fields_.end(), row_.begin(), row_.end());
  }

  CsvOptions options_;
  CsvTable table_;
  std::vector<std::string_view> row_;
  std::vector<Problem> problems_;
};

CsvTable parse_csv(std::string text, const std::string& name, const CsvOptions& options) {
  return CsvParser(std::move(text), name, options).run();
}

CsvTable read_csv(const std::filesystem::path& path, const CsvOptions& options) {
  return parse_csv(read_text_file(path), path.string(), options);
}

}  // namespace astroid
