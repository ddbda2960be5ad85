// What the reader needs of a table, whether it came from text or from FITS.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {

class CatalogueTable {
 public:
  CatalogueTable() = default;
  virtual ~CatalogueTable() = default;
  CatalogueTable(const CatalogueTable&) = delete;
  CatalogueTable& operator=(const CatalogueTable&) = delete;
  CatalogueTable(CatalogueTable&&) = delete;
  CatalogueTable& operator=(CatalogueTable&&) = delete;

  [[nodiscard]] virtual const std::string& file() const = 0;
  /// Empty: the file has no names of columns.
  [[nodiscard]] virtual const std::vector<std::string>& names() const = 0;
  [[nodiscard]] virtual std::size_t columns() const = 0;
  [[nodiscard]] virtual std::size_t rows() const = 0;
  [[nodiscard]] virtual std::string text(std::size_t row, std::size_t column) const = 0;
  /// Nothing: the cell is no number. A missing value is NaN or no number.
  [[nodiscard]] virtual std::optional<double> number(std::size_t row, std::size_t column) const = 0;
  /// "line 12" of a text, "row 12" of a FITS table.
  [[nodiscard]] virtual std::string where(std::size_t row) const = 0;
  [[nodiscard]] virtual Problem problem(std::size_t row, std::size_t column, const std::string& message,
                                        const std::string& expected) const = 0;
  /// Line of the names, or 0.
  [[nodiscard]] virtual long names_line() const { return 0; }
  /// The unit that the file itself states for a column ("deg", "rad"), or empty.
  [[nodiscard]] virtual std::string unit(std::size_t /*column*/) const { return {}; }
  /// The passband that the file itself states for its column `mag`, or empty.
  [[nodiscard]] virtual std::string stated_passband() const { return {}; }
};

[[nodiscard]] std::unique_ptr<CatalogueTable> read_text_table(const std::filesystem::path& path);
[[nodiscard]] std::unique_ptr<CatalogueTable> read_fits_table(const std::filesystem::path& path);
/// Whichever of the two the file is, by its first bytes.
[[nodiscard]] std::unique_ptr<CatalogueTable> read_catalogue_table(const std::filesystem::path& path);

}  // namespace astroid
