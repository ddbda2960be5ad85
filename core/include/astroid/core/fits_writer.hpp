// FITS files that are either complete or absent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/fits_card.hpp"
#include "astroid/core/image.hpp"

namespace astroid {

/// How numbers are stored.
enum class FitsNumber {
  kUnsigned8,
  kUnsigned16,  ///< 16-bit integers with BZERO = 32768; images only
  kInt32,
  kInt64,
  kFloat32,
  kFloat64,
};

/// One column of a binary table.
struct FitsColumn {
  std::string name{};
  FitsNumber number = FitsNumber::kFloat64;
  std::string unit{};
  int text_width = 0;  ///< > 0: a column of texts of at most so many bytes; `number` is then ignored
};

/// Writes a FITS file by CFITSIO under partial_path(path); commit() completes, synchronises and renames it.
///
/// Header-data units are begun one after the other; cards go to the current one, best before its first pixel, because a
/// header that outgrows its block moves all data behind it. An earlier unit can be selected again, so images that grow
/// together need no memory. Every unit gets EXTNAME if named, DATE (UTC, of SOURCE_DATE_EPOCH if that is set), CHECKSUM
/// and DATASUM; nothing else is added (no CREATOR). What pixels hold that were never written is not defined.
///
/// @throws EnvironmentError(path, cause) from every member function, a full disk included; without commit() nothing is
/// left.
/// @thread one thread at a time per writer, but for write_large_pixels(); different writers in different threads.
class FitsWriter {
 public:
  explicit FitsWriter(std::filesystem::path path);
  ~FitsWriter();
  FitsWriter(FitsWriter&& other) noexcept;
  FitsWriter& operator=(FitsWriter&&) = delete;
  FitsWriter(const FitsWriter&) = delete;
  FitsWriter& operator=(const FitsWriter&) = delete;

  /// Begins an image; the first one is the primary unit.
  /// @param axes  NAXIS1, NAXIS2, …: columns first; empty for a header without data.  @returns its number, from 1.
  int begin_image(FitsNumber pixel, const std::vector<std::int64_t>& axes, const std::string& name = {});

  /// The same for an image larger than memory that is written piece by piece in any order, such as FLUX[star][exposure]
  /// in blocks of exposures: its space is set aside at once, unwritten pixels are 0 (32768 for kUnsigned16), and pixels
  /// go to the disk without detours. Pixels must have the type of `pixel`, and keywords come before the first of them
  /// (BugError).
  int begin_large_image(FitsNumber pixel, const std::vector<std::int64_t>& axes, const std::string& name = {});

  /// Ends the header of the current large image; write_large_pixels() may then write to it.
  void end_large_header();

  /// Begins a binary table, after an empty primary unit if it is the first. Rows are added as they are written;
  /// only the last unit should grow.  @returns its number, from 1.
  int begin_table(const std::vector<FitsColumn>& columns, const std::string& name, std::int64_t rows = 0);

  /// Makes unit `number` the current one again.
  void select(int number);

  /// Sets a keyword of the current unit; an old value of it is replaced.
  void card(const FitsCard& card);
  void cards(std::span<const FitsCard> cards);
  /// Adds a HISTORY line, continued over several cards when it is long; bytes that are not ASCII become '?'.
  void history(std::string_view line);

  /// Writes consecutive pixels of the current image, the first at position `first` in storage order: (plane * NAXIS2 +
  /// row) * NAXIS1 + column. Floating-point values into an integer image must be whole and in range (BugError).
  void write_pixels(std::int64_t first, std::span<const std::uint8_t> values);
  void write_pixels(std::int64_t first, std::span<const std::uint16_t> values);
  void write_pixels(std::int64_t first, std::span<const std::int32_t> values);
  void write_pixels(std::int64_t first, std::span<const float> values);
  void write_pixels(std::int64_t first, std::span<const double> values);

  /// The same for the large image `number`, which need not be the current one. @throws BugError before
  /// end_large_header().
  /// @thread several at a time, for pixels that do not overlap, while no other function of this writer runs.
  void write_large_pixels(int number, std::int64_t first, std::span<const float> values) const;

  /// Writes a whole plane of the current image (plane 0 of a two-dimensional one).
  template <class T, class Unit>
  void write_plane(ImageView<const T, Unit> image, std::int64_t plane = 0) {
    check_plane(image.nx(), image.ny(), plane);
    for (int row = 0; row < image.ny(); ++row) {
      write_pixels((plane * image.ny() + row) * image.nx(), std::span<const T>(image.row(image.area().y0 + row)));
    }
  }
  template <class T, class Unit>
  void write_plane(const Image<T, Unit>& image, std::int64_t plane = 0) {
    check_plane(image.nx(), image.ny(), plane);
    write_pixels(plane * static_cast<std::int64_t>(image.size()), image.pixels());
  }

  /// Writes consecutive rows of one column of the current table. Rows and columns count from 0. @throws BugError when a
  /// text is longer than its column.
  void write_column(std::size_t column, std::int64_t first_row, std::span<const double> values);
  void write_column(std::size_t column, std::int64_t first_row, std::span<const float> values);
  void write_column(std::size_t column, std::int64_t first_row, std::span<const std::int32_t> values);
  void write_column(std::size_t column, std::int64_t first_row, std::span<const std::int64_t> values);
  void write_column(std::size_t column, std::int64_t first_row, std::span<const std::string> values);

  /// Completes all units and gives the file its name. Nothing can be written afterwards.
  void commit(Durability durability = Durability::kAtOnce);

 private:
  struct State;
  void check_plane(int nx, int ny, std::int64_t plane) const;
  std::unique_ptr<State> state_;
};

}  // namespace astroid
