#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "astroid/core/csv.hpp"
#include "catalogue_table.hpp"

namespace astroid {

namespace {

constexpr std::string_view kPassbandComment = "passband:";  // written by write_catalogue_csv

class TextCatalogueTable final : public CatalogueTable {
 public:
  explicit TextCatalogueTable(CsvTable table) : table_(std::move(table)) {}

  [[nodiscard]] const std::string& file() const override { return table_.file(); }
  [[nodiscard]] const std::vector<std::string>& names() const override { return table_.header(); }
  [[nodiscard]] std::size_t columns() const override { return table_.columns(); }
  [[nodiscard]] std::size_t rows() const override { return table_.rows(); }
  [[nodiscard]] std::string text(std::size_t row, std::size_t column) const override {
    return std::string(table_.field(row, column));
  }
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column) const override {
    return table_.number(row, column);
  }
  [[nodiscard]] std::string where(std::size_t row) const override { return fmt::format("line {}", table_.line(row)); }
  [[nodiscard]] Problem problem(std::size_t row, std::size_t column, const std::string& message,
                                const std::string& expected) const override {
    return table_.problem(row, column, message, expected);
  }
  [[nodiscard]] long names_line() const override { return table_.header_line(); }
  [[nodiscard]] std::string stated_passband() const override {
    for (const CsvTable::Comment& comment : table_.comments()) {
      if (!comment.text.starts_with(kPassbandComment)) continue;
      const std::string_view rest = comment.text.substr(kPassbandComment.size());
      const std::size_t first = rest.find_first_not_of(' ');
      if (first != std::string_view::npos) return std::string(rest.substr(first));
    }
    return {};
  }

 private:
  CsvTable table_;
};

}  // namespace

std::unique_ptr<CatalogueTable> read_text_table(const std::filesystem::path& path) {
  return std::make_unique<TextCatalogueTable>(read_csv(path));
}

}  // namespace astroid
