#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "astroid/core/csv.hpp"
#include "astroid/core/fits.hpp"
#include "catalogue_table.hpp"

namespace astroid {

namespace {

/// The first table of a FITS file; columns are read when they are first asked for.
class FitsCatalogueTable final : public CatalogueTable {
 public:
  explicit FitsCatalogueTable(const std::filesystem::path& path)
      : reader_(path), unit_(reader_.first_table()), info_(reader_.columns(unit_)) {
    for (const FitsColumnInfo& column : info_) {
      // A column of vectors cannot be a star's position or magnitude, so it has no name that could be one.
      names_.push_back(column.per_row == 1 ? column.name : std::string());
    }
  }

  [[nodiscard]] const std::string& file() const override { return reader_.file(); }
  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] std::size_t columns() const override { return names_.size(); }
  [[nodiscard]] std::size_t rows() const override {
    return static_cast<std::size_t>(reader_.units()[static_cast<std::size_t>(unit_ - 1)].rows);
  }
  [[nodiscard]] std::string text(std::size_t row, std::size_t column) const override {
    if (info_[column].is_integer) {
      const std::int64_t value = integers(column)[row];
      return value == std::numeric_limits<std::int64_t>::min() ? std::string() : std::to_string(value);
    }
    return texts(column)[row];
  }
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column) const override {
    if (info_[column].is_text) return parse_number(texts(column)[row]);
    return numbers(column)[row];
  }
  [[nodiscard]] std::string where(std::size_t row) const override { return fmt::format("row {}", row + 1); }
  [[nodiscard]] Problem problem(std::size_t row, std::size_t column, const std::string& message,
                                const std::string& expected) const override {
    return {.file = file(),
            .line = 0,
            .parameter = fmt::format("row {}, column {}", row + 1, names_[column]),
            .value = text(row, column),
            .expected = expected,
            .message = message,
            .suggestion = {}};
  }
  [[nodiscard]] std::string unit(std::size_t column) const override {
    const std::string& unit = info_[column].unit;
    if (unit.starts_with("deg")) return "deg";
    if (unit.starts_with("rad")) return "rad";
    return unit;
  }

 private:
  template <class Values, class Read>
  static const Values& cached(std::map<std::size_t, Values>& cache, std::size_t column, const Read& read) {
    const auto known = cache.find(column);
    return known != cache.end() ? known->second : cache.emplace(column, read()).first->second;
  }
  const std::vector<double>& numbers(std::size_t column) const {
    return cached(numbers_, column, [&] { return reader_.read_numbers(unit_, column); });
  }
  const std::vector<std::int64_t>& integers(std::size_t column) const {
    return cached(integers_, column, [&] { return reader_.read_integers(unit_, column); });
  }
  const std::vector<std::string>& texts(std::size_t column) const {
    return cached(texts_, column, [&] { return reader_.read_texts(unit_, column); });
  }

  FitsReader reader_;
  int unit_;
  std::vector<FitsColumnInfo> info_;
  std::vector<std::string> names_;
  mutable std::map<std::size_t, std::vector<double>> numbers_;
  mutable std::map<std::size_t, std::vector<std::int64_t>> integers_;
  mutable std::map<std::size_t, std::vector<std::string>> texts_;
};

}  // namespace

std::unique_ptr<CatalogueTable> read_fits_table(const std::filesystem::path& path) {
  return std::make_unique<FitsCatalogueTable>(path);
}

}  // namespace astroid
