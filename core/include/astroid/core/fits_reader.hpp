// Reading anybody's FITS files.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/image.hpp"

namespace astroid {

/// What one header-data unit holds.
struct FitsUnit {
  enum class Kind { kImage, kTable };
  Kind kind = Kind::kImage;
  std::string name{};                ///< EXTNAME or empty
  std::vector<std::int64_t> axes{};  ///< of an image: NAXIS1 (columns), NAXIS2 (rows), …; empty: header only
  std::int64_t rows = 0;             ///< of a table
  /// "an image of 100 x 80 px", "a table of 12 rows": for messages.
  [[nodiscard]] std::string text() const;
};

/// A column of a table.
struct FitsColumnInfo {
  std::string name{};
  std::string unit{};
  bool is_text = false;
  bool is_integer = false;   ///< whole numbers, unscaled
  std::int64_t per_row = 1;  ///< numbers in one row; of a text column 1
};

/// Reads images, tables and headers of a FITS file by CFITSIO; files compressed by gzip or by tiles too.
///
/// Nothing is believed before it is checked against the size of the file, so a damaged header cannot ask for absurd
/// memory.
/// @throws EnvironmentError(path, cause) when the file is missing or may not be read; InputError, naming the file and
/// what was
///         expected, when it is empty, not FITS, truncated or holds something else; from every member function.
/// @thread one thread at a time per reader; different readers in different threads, of the same file too.
class FitsReader {
 public:
  explicit FitsReader(const std::filesystem::path& path);
  ~FitsReader();
  FitsReader(FitsReader&&) noexcept;
  FitsReader& operator=(FitsReader&&) = delete;
  FitsReader(const FitsReader&) = delete;
  FitsReader& operator=(const FitsReader&) = delete;

  /// All units; `units()[n - 1]` is number n, the numbers that the functions below take.
  [[nodiscard]] const std::vector<FitsUnit>& units() const;
  [[nodiscard]] const std::string& file() const;

  /// The first unit that holds an image with data. @throws InputError when there is none.
  [[nodiscard]] int first_image() const;
  /// The unit of that EXTNAME (case does not matter), or nothing.
  [[nodiscard]] std::optional<int> find_unit(const std::string& name) const;
  /// The first table. @throws InputError when there is none.
  [[nodiscard]] int first_table() const;

  // Headers. Absent or empty keywords give nothing; ones of another type an InputError.
  [[nodiscard]] std::optional<double> number(int unit, const std::string& key) const;
  [[nodiscard]] std::optional<std::int64_t> integer(int unit, const std::string& key) const;
  [[nodiscard]] std::optional<bool> flag(int unit, const std::string& key) const;
  [[nodiscard]] std::optional<std::string> text(int unit, const std::string& key) const;
  /// What stands in brackets at the start of a keyword's comment, as FITS writes units: "adu" of `/ [adu] bias`.
  [[nodiscard]] std::optional<std::string> unit_of(int unit, const std::string& key) const;
  /// The lines of 80 characters one after the other, as SkyProjection::from_header takes them.
  [[nodiscard]] std::string header_text(int unit) const;
  [[nodiscard]] std::vector<std::string> history(int unit) const;

  /// A two-dimensional image (axes of length 1 beyond the second are ignored); BSCALE and BZERO applied, BLANK as NaN.
  /// @throws InputError also when the unit has another number of axes: read_plane() reads cubes.
  template <std::floating_point T, class Unit>
  [[nodiscard]] Image<T, Unit> read_image(int unit) const {
    return read_section<T, Unit>(unit, whole_image(unit));
  }
  /// Part of it; area() of the result is `section`. @throws InputError when it reaches beyond the image.
  template <std::floating_point T, class Unit>
  [[nodiscard]] Image<T, Unit> read_section(int unit, const Rectangle& section, std::int64_t plane = 0) const {
    check_section(unit, section, plane);
    Image<T, Unit> image(section);
    for (int y = section.y0; y < section.y1(); ++y) read_row(unit, section.x0, y, plane, image.row(y));
    return image;
  }
  /// One plane of a cube.
  template <std::floating_point T, class Unit>
  [[nodiscard]] Image<T, Unit> read_plane(int unit, std::int64_t plane) const {
    return read_section<T, Unit>(unit, whole_plane(unit), plane);
  }
  /// Consecutive pixels in storage order, whatever the number of axes.
  void read_pixels(int unit, std::int64_t first, std::span<float> values) const;
  void read_pixels(int unit, std::int64_t first, std::span<double> values) const;

  [[nodiscard]] std::vector<FitsColumnInfo> columns(int unit) const;
  /// Index of the column of that name: exactly, else the first that differs in case only, else nothing.
  [[nodiscard]] std::optional<std::size_t> find_column(int unit, const std::string& name) const;
  /// Numbers of `count` rows (per_row of each), scaled; missing ones NaN.
  [[nodiscard]] std::vector<double> read_numbers(int unit, std::size_t column, std::int64_t first_row,
                                                 std::int64_t count) const;
  [[nodiscard]] std::vector<double> read_numbers(int unit, std::size_t column) const;
  /// Whole numbers; missing ones the smallest std::int64_t. @throws InputError when the column holds others.
  [[nodiscard]] std::vector<std::int64_t> read_integers(int unit, std::size_t column, std::int64_t first_row,
                                                        std::int64_t count) const;
  [[nodiscard]] std::vector<std::int64_t> read_integers(int unit, std::size_t column) const;
  /// One text a row, without the blanks at its end; numbers in the shortest form that reads back.
  [[nodiscard]] std::vector<std::string> read_texts(int unit, std::size_t column) const;

 private:
  struct State;
  [[nodiscard]] Rectangle whole_image(int unit) const;
  [[nodiscard]] Rectangle whole_plane(int unit) const;
  [[nodiscard]] FitsColumnInfo column_info(int unit, std::size_t column) const;
  void check_section(int unit, const Rectangle& section, std::int64_t plane) const;
  void read_row(int unit, int x, int y, std::int64_t plane, std::span<float> values) const;
  void read_row(int unit, int x, int y, std::int64_t plane, std::span<double> values) const;
  std::unique_ptr<State> state_;
};

}  // namespace astroid
