// Tables of FITS files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include "astroid/core/csv.hpp"
#include "fits_file.hpp"

namespace astroid {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return text;
}

struct ColumnType {
  int code = 0;
  LONGLONG repeat = 0;
  LONGLONG width = 0;
};

}  // namespace

std::vector<FitsColumnInfo> FitsReader::columns(int unit) const {
  (void)state_->go_to(unit, FitsUnit::Kind::kTable);
  int count = 0;
  state_->call(&ffgncl, &count);
  std::vector<FitsColumnInfo> result;
  for (int i = 1; i <= count; ++i) {
    ColumnType type;
    state_->call(&ffgtclll, i, &type.code, &type.repeat, &type.width);
    FitsColumnInfo info;
    info.name = text(unit, fmt::format("TTYPE{}", i)).value_or("");
    info.unit = text(unit, fmt::format("TUNIT{}", i)).value_or("");
    info.is_text = std::abs(type.code) == TSTRING;
    const double scale = number(unit, fmt::format("TSCAL{}", i)).value_or(1.0);
    const double zero = number(unit, fmt::format("TZERO{}", i)).value_or(0.0);
    const bool integer_type = type.code == TBYTE || type.code == TSBYTE || type.code == TSHORT ||
                              type.code == TUSHORT || type.code == TLONG || type.code == TULONG || type.code == TINT ||
                              type.code == TUINT || type.code == TLONGLONG || type.code == TULONGLONG;
    info.is_integer = integer_type && scale == 1.0 && zero == std::floor(zero);
    info.per_row = info.is_text ? 1 : type.repeat;
    result.push_back(std::move(info));
  }
  return result;
}

std::optional<std::size_t> FitsReader::find_column(int unit, const std::string& name) const {
  const std::vector<FitsColumnInfo> all = columns(unit);
  std::optional<std::size_t> other_case;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
    if (!other_case && lower(all[i].name) == lower(name)) other_case = i;
  }
  return other_case;
}

void FitsReader::State::check_rows(int unit, std::int64_t first, std::int64_t count) const {
  const std::int64_t rows = units[static_cast<std::size_t>(unit) - 1].rows;
  if (first < 0 || count < 0 || first > rows || count > rows - first)
    throw refuse(fmt::format("{} has no rows {} to {}", unit_text(unit), first, first + count), "rows of the table");
}

std::vector<double> FitsReader::read_numbers(int unit, std::size_t column, std::int64_t first_row,
                                             std::int64_t count) const {
  const FitsColumnInfo info = column_info(unit, column);
  if (info.is_text)
    throw state_->refuse(fmt::format("column {} of {} holds texts", info.name, state_->unit_text(unit)), "numbers");
  state_->check_rows(unit, first_row, count);
  std::vector<double> values(static_cast<std::size_t>(count * info.per_row));
  if (values.empty()) return values;
  double missing = std::numeric_limits<double>::quiet_NaN();
  int any_missing = 0;
  state_->call(&ffgcv, TDOUBLE, static_cast<int>(column) + 1, LONGLONG{first_row + 1}, LONGLONG{1},
               static_cast<LONGLONG>(values.size()), &missing, values.data(), &any_missing);
  return values;
}

std::vector<double> FitsReader::read_numbers(int unit, std::size_t column) const {
  (void)state_->go_to(unit, FitsUnit::Kind::kTable);
  return read_numbers(unit, column, 0, units()[static_cast<std::size_t>(unit) - 1].rows);
}

std::vector<std::int64_t> FitsReader::read_integers(int unit, std::size_t column, std::int64_t first_row,
                                                    std::int64_t count) const {
  const FitsColumnInfo info = column_info(unit, column);
  if (!info.is_integer) {
    throw state_->refuse(
        fmt::format("column {} of {} holds other than whole numbers", info.name, state_->unit_text(unit)),
        "whole numbers");
  }
  state_->check_rows(unit, first_row, count);
  std::vector<std::int64_t> values(static_cast<std::size_t>(count * info.per_row));
  if (values.empty()) return values;
  LONGLONG missing = std::numeric_limits<std::int64_t>::min();
  int any_missing = 0;
  std::vector<LONGLONG> numbers(values.size());
  state_->call(&ffgcv, TLONGLONG, static_cast<int>(column) + 1, LONGLONG{first_row + 1}, LONGLONG{1},
               static_cast<LONGLONG>(numbers.size()), &missing, numbers.data(), &any_missing);
  std::copy(numbers.begin(), numbers.end(), values.begin());
  return values;
}

std::vector<std::int64_t> FitsReader::read_integers(int unit, std::size_t column) const {
  (void)state_->go_to(unit, FitsUnit::Kind::kTable);
  return read_integers(unit, column, 0, units()[static_cast<std::size_t>(unit) - 1].rows);
}

std::vector<std::string> FitsReader::read_texts(int unit, std::size_t column) const {
  const FitsColumnInfo info = column_info(unit, column);
  const std::int64_t rows = units()[static_cast<std::size_t>(unit) - 1].rows;
  std::vector<std::string> texts;
  texts.reserve(static_cast<std::size_t>(rows));
  if (!info.is_text) {
    if (info.per_row != 1) {
      throw state_->refuse(
          fmt::format("column {} of {} holds several numbers a row", info.name, state_->unit_text(unit)),
          "one text a row");
    }
    if (info.is_integer) {
      for (const std::int64_t value : read_integers(unit, column)) texts.push_back(fmt::format("{}", value));
    } else {
      for (const double value : read_numbers(unit, column)) texts.push_back(shortest_text(value));
    }
    return texts;
  }
  if (rows == 0) return texts;
  ColumnType type;
  state_->call(&ffgtclll, static_cast<int>(column) + 1, &type.code, &type.repeat, &type.width);
  // Row by row, so that neither width nor number of rows asks for more memory than the texts themselves.
  std::string buffer(static_cast<std::size_t>(std::max(type.repeat, type.width)) + 1, '\0');
  std::array<char, 1> missing{};
  int any_missing = 0;
  for (std::int64_t row = 1; row <= rows; ++row) {
    char* pointer = buffer.data();
    state_->call(&ffgcvs, static_cast<int>(column) + 1, LONGLONG{row}, LONGLONG{1}, LONGLONG{1}, missing.data(),
                 &pointer, &any_missing);
    std::string value(buffer.c_str());
    value.erase(value.find_last_not_of(' ') + 1);
    texts.push_back(std::move(value));
  }
  return texts;
}

FitsColumnInfo FitsReader::column_info(int unit, std::size_t column) const {
  const std::vector<FitsColumnInfo> all = columns(unit);
  if (column >= all.size()) {
    throw state_->refuse(fmt::format("{} has no column {}", state_->unit_text(unit), column),
                         fmt::format("one of {} columns", all.size()));
  }
  ColumnType type;
  state_->call(&ffgtclll, static_cast<int>(column) + 1, &type.code, &type.repeat, &type.width);
  if (type.code < 0) {
    throw state_->refuse(
        fmt::format("column {} of {} holds arrays of variable length", all[column].name, state_->unit_text(unit)),
        "a column of fixed length");
  }
  return all[column];
}

}  // namespace astroid
