#include "astroid/core/fits_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <system_error>
#include <type_traits>
#include <utility>

#include "astroid/core/error.hpp"
#include "cfitsio_call.hpp"
#include "fits_cards.hpp"
#include "fits_checksum.hpp"
#include "fits_large_image.hpp"

namespace astroid {

namespace {

int image_code(FitsNumber number) {
  switch (number) {
    case FitsNumber::kUnsigned8:
      return BYTE_IMG;
    case FitsNumber::kUnsigned16:
      return USHORT_IMG;
    case FitsNumber::kInt32:
      return LONG_IMG;
    case FitsNumber::kInt64:
      return LONGLONG_IMG;
    case FitsNumber::kFloat32:
      return FLOAT_IMG;
    case FitsNumber::kFloat64:
      return DOUBLE_IMG;
  }
  throw BugError("FitsWriter: unknown number format");
}

std::string column_format(const FitsColumn& column) {
  if (column.text_width > 0) return fmt::format("{}A", column.text_width);
  switch (column.number) {
    case FitsNumber::kUnsigned8:
      return "1B";
    case FitsNumber::kInt32:
      return "1J";
    case FitsNumber::kInt64:
      return "1K";
    case FitsNumber::kFloat32:
      return "1E";
    case FitsNumber::kFloat64:
      return "1D";
    case FitsNumber::kUnsigned16:
      break;
  }
  throw BugError("FitsWriter: column " + column.name + " has a format for images only");
}

template <class T>
constexpr int type_code() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return TBYTE;
  if constexpr (std::is_same_v<T, std::uint16_t>) return TUSHORT;
  if constexpr (std::is_same_v<T, std::int32_t>) return TINT;
  if constexpr (std::is_same_v<T, std::int64_t>) return TLONGLONG;
  if constexpr (std::is_same_v<T, float>) return TFLOAT;
  return TDOUBLE;
}

template <class T>
constexpr FitsNumber native_format() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return FitsNumber::kUnsigned8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return FitsNumber::kUnsigned16;
  if constexpr (std::is_same_v<T, std::int32_t>) return FitsNumber::kInt32;
  if constexpr (std::is_same_v<T, float>) return FitsNumber::kFloat32;
  return FitsNumber::kFloat64;
}

// Largest and smallest value of an integer format; nothing to check for the others.
std::pair<double, double> integer_range(FitsNumber number) {
  switch (number) {
    case FitsNumber::kUnsigned8:
      return {0.0, std::numeric_limits<std::uint8_t>::max()};
    case FitsNumber::kUnsigned16:
      return {0.0, std::numeric_limits<std::uint16_t>::max()};
    case FitsNumber::kInt32:
      return {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};
    default:
      return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
}

}  // namespace

struct FitsWriter::State {
  struct Unit {
    bool is_image = true;
    FitsNumber pixel = FitsNumber::kUnsigned8;
    std::vector<std::int64_t> axes{};
    std::vector<int> text_widths{};  // of a table's columns, 0 for numbers
    bool is_large = false;           // pixels are written past CFITSIO
    std::int64_t data_start = 0;     // byte where pixels of a large image begin; 0 as long as its header may grow
  };

  std::filesystem::path path;
  fitsfile* file = nullptr;
  std::vector<Unit> units{};
  std::size_t current = 0;
  int descriptor = -1;  // a second way to the file, for large images and the end

  explicit State(std::filesystem::path p) : path(std::move(p)) {}
  ~State() {
    if (file != nullptr || descriptor >= 0) discard();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  State(State&&) = delete;
  State& operator=(State&&) = delete;

  // Runs a function of a CFITSIO status and turns failure into an EnvironmentError.
  template <class Function>
  void checked(Function function) {
    if (file == nullptr) throw BugError("FitsWriter: used after its end: " + path.string());
    const CfitsioLock lock;
    int status = 0;
    errno = 0;
    function(&status);
    if (status != 0) throw EnvironmentError(path.string(), cfitsio_message(status, errno));
  }
  // The same for a function of CFITSIO.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) {
    checked([&](int* status) { function(file, arguments..., status); });
  }

  // Runs a function on the second descriptor and names the file when it fails.
  template <class Function>
  void attempt(Function function) {
    try {
      if (descriptor < 0) descriptor = ::open(partial_path(path).c_str(), O_RDWR | O_CLOEXEC);
      if (descriptor < 0) throw std::system_error(errno, std::generic_category());
      function();
    } catch (const std::system_error& error) {
      throw EnvironmentError(path.string(), error.code().message());
    }
  }

  void discard() {
    if (file != nullptr) {
      const CfitsioLock lock;
      int ignored = 0;
      fits_close_file(std::exchange(file, nullptr), &ignored);
      fits_clear_errmsg();
    }
    if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
    ::unlink(partial_path(path).c_str());
  }

  // Ends the header of a large image and sets its space aside. CFITSIO would fill it with zeros, block by block, and
  // does not look for itself how long a file has become: hence the two sizes in its structure.
  void seal() {
    if (units.empty() || !units[current].is_large || units[current].data_start != 0) return;
    LONGLONG start = 0;
    LONGLONG end = 0;
    call(&ffrdef);
    call(&ffghadll, static_cast<LONGLONG*>(nullptr), &start, &end);
    call(&ffflsh, 1);
    attempt([&] { set_file_size(descriptor, end); });
    file->Fptr->filesize = end;
    file->Fptr->logfilesize = end;
    units[current].data_start = start;
  }

  int finish_beginning(Unit unit, const std::string& name) {
    units.push_back(std::move(unit));
    current = units.size() - 1;
    checked([&](int* status) { set_fits_unit_cards(file, name, status); });
    return static_cast<int>(units.size());
  }

  void set(const FitsCard& card) {
    if (units.empty()) throw BugError("FitsWriter: keyword before the first unit");
    if (units[current].data_start != 0) throw BugError("FitsWriter: keyword after the first pixel of a large image");
    checked([&](int* status) { set_fits_card(file, card, status); });
  }

  template <class T>
  void write_pixels(std::int64_t first, std::span<const T> values) {
    const Unit& unit = current_unit(true);
    if (std::is_floating_point_v<T> && !unit.is_large) {
      const auto [low, high] = integer_range(unit.pixel);
      const bool integer = std::isfinite(high);
      for (const T value : values) {
        const double v = static_cast<double>(value);
        if (integer && !(v >= low && v <= high && v == std::floor(v))) {
          throw BugError(
              fmt::format("FitsWriter: pixel value {} does not fit the integer image of {}", v, path.string()));
        }
      }
    }
    check_range(unit, first, values.size());
    if (values.empty()) return;
    if (unit.is_large) {
      seal();
      write_large_pixels(unit, first, values);
      return;
    }
    // CFITSIO takes its input as mutable but does not change it.
    call(&ffppr, type_code<T>(), LONGLONG{first + 1}, static_cast<LONGLONG>(values.size()),
         mutable_pointer(values.data()));
  }

  static void check_range(const Unit& unit, std::int64_t first, std::size_t count) {
    const std::int64_t size =
        unit.axes.empty() ? 0
                          : std::accumulate(unit.axes.begin(), unit.axes.end(), std::int64_t{1}, std::multiplies<>());
    ASTROID_CHECK_LE(std::int64_t{0}, first);
    ASTROID_CHECK_LE(first + static_cast<std::int64_t>(count), size);
  }

  // Changes nothing but the file, so several threads may write at a time.
  template <class T>
  void write_large_pixels(const Unit& unit, std::int64_t first, std::span<const T> values) const {
    if (!unit.is_large || unit.data_start == 0) throw BugError("FitsWriter: not a large image whose header has ended");
    if (unit.pixel != native_format<T>()) throw BugError("FitsWriter: pixels of a large image have another type");
    try {
      write_fits_numbers(descriptor, unit.data_start + first * static_cast<std::int64_t>(sizeof(T)), values);
    } catch (const std::system_error& error) {
      throw EnvironmentError(path.string(), error.code().message());
    }
  }

  template <class T>
  void write_column(std::size_t column, std::int64_t first_row, std::span<const T> values) {
    (void)column_width(column);
    if (values.empty()) return;
    call(&ffpcl, type_code<T>(), static_cast<int>(column) + 1, LONGLONG{first_row + 1}, LONGLONG{1},
         static_cast<LONGLONG>(values.size()), mutable_pointer(values.data()));
  }

  [[nodiscard]] int column_width(std::size_t column) const {
    const Unit& unit = current_unit(false);
    ASTROID_CHECK_LT(column, unit.text_widths.size());
    return unit.text_widths[column];
  }

  [[nodiscard]] const Unit& current_unit(bool image) const {
    if (units.empty() || units[current].is_image != image)
      throw BugError("FitsWriter: the current unit is of another kind");
    return units[current];
  }

  template <class T>
  static void* mutable_pointer(const T* data) {
    return const_cast<T*>(data);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  }
};

FitsWriter::FitsWriter(std::filesystem::path path) : state_(std::make_unique<State>(std::move(path))) {
  State& s = *state_;
  if (!s.path.has_filename()) throw EnvironmentError(s.path.string(), "is not the name of a file");
  if (std::filesystem::is_directory(s.path)) throw EnvironmentError(s.path.string(), "Is a directory");
  const std::string partial = partial_path(s.path).string();
  ::unlink(partial.c_str());  // what a run that was killed left behind; CFITSIO refuses to write over it
  const CfitsioLock lock;
  int status = 0;
  errno = 0;
  fits_create_diskfile(&s.file, partial.c_str(), &status);
  if (status != 0) {
    s.file = nullptr;
    throw EnvironmentError(s.path.string(), cfitsio_message(status, errno));
  }
}

FitsWriter::~FitsWriter() = default;
FitsWriter::FitsWriter(FitsWriter&& other) noexcept = default;

int FitsWriter::begin_image(FitsNumber pixel, const std::vector<std::int64_t>& axes, const std::string& name) {
  state_->seal();
  std::vector<LONGLONG> lengths(axes.begin(), axes.end());
  state_->call(&ffcrimll, image_code(pixel), static_cast<int>(lengths.size()), lengths.data());
  return state_->finish_beginning({.is_image = true, .pixel = pixel, .axes = axes}, name);
}

int FitsWriter::begin_large_image(FitsNumber pixel, const std::vector<std::int64_t>& axes, const std::string& name) {
  const int number = begin_image(pixel, axes, name);
  state_->units.back().is_large = true;
  return number;
}

void FitsWriter::end_large_header() {
  if (!state_->current_unit(true).is_large) throw BugError("FitsWriter: the current unit is not a large image");
  state_->seal();
}

void FitsWriter::write_large_pixels(int number, std::int64_t first, std::span<const float> values) const {
  ASTROID_CHECK_LE(1, number);
  ASTROID_CHECK_LE(static_cast<std::size_t>(number), state_->units.size());
  const State::Unit& unit = state_->units[static_cast<std::size_t>(number) - 1];
  State::check_range(unit, first, values.size());
  state_->write_large_pixels(unit, first, values);
}

int FitsWriter::begin_table(const std::vector<FitsColumn>& columns, const std::string& name, std::int64_t rows) {
  if (state_->units.empty()) (void)begin_image(FitsNumber::kUnsigned8, {});
  state_->seal();
  State::Unit unit{.is_image = false};
  std::vector<std::string> names;
  std::vector<std::string> formats;
  std::vector<std::string> units;
  for (const FitsColumn& column : columns) {
    names.push_back(column.name);
    formats.push_back(column_format(column));
    units.push_back(column.unit);
    unit.text_widths.push_back(column.text_width);
  }
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size());
    for (std::string& text : texts) result.push_back(text.data());
    return result;
  };
  state_->call(&ffcrtb, static_cast<int>(BINARY_TBL), LONGLONG{rows}, static_cast<int>(columns.size()),
               pointers(names).data(), pointers(formats).data(), pointers(units).data(),
               static_cast<const char*>(nullptr));
  return state_->finish_beginning(std::move(unit), name);
}

void FitsWriter::select(int number) {
  ASTROID_CHECK_LE(1, number);
  ASTROID_CHECK_LE(static_cast<std::size_t>(number), state_->units.size());
  if (state_->current == static_cast<std::size_t>(number) - 1) return;
  state_->seal();
  state_->call(&ffmahd, number, static_cast<int*>(nullptr));
  state_->current = static_cast<std::size_t>(number) - 1;
}

void FitsWriter::card(const FitsCard& card) {
  state_->set(card);
}

void FitsWriter::cards(std::span<const FitsCard> cards) {
  for (const FitsCard& card : cards) state_->set(card);
}

void FitsWriter::history(std::string_view line) {
  State& s = *state_;
  s.checked([&](int* status) { add_fits_history(s.file, line, status); });
}

void FitsWriter::check_plane(int nx, int ny, std::int64_t plane) const {
  const State::Unit& unit = state_->current_unit(true);
  ASTROID_CHECK_LE(std::size_t{2}, unit.axes.size());
  ASTROID_CHECK_EQ(static_cast<std::int64_t>(nx), unit.axes[0]);
  ASTROID_CHECK_EQ(static_cast<std::int64_t>(ny), unit.axes[1]);
  ASTROID_CHECK_LE(std::int64_t{0}, plane);
}

void FitsWriter::write_pixels(std::int64_t first, std::span<const std::uint8_t> values) {
  state_->write_pixels(first, values);
}
void FitsWriter::write_pixels(std::int64_t first, std::span<const std::uint16_t> values) {
  state_->write_pixels(first, values);
}
void FitsWriter::write_pixels(std::int64_t first, std::span<const std::int32_t> values) {
  state_->write_pixels(first, values);
}
void FitsWriter::write_pixels(std::int64_t first, std::span<const float> values) {
  state_->write_pixels(first, values);
}
void FitsWriter::write_pixels(std::int64_t first, std::span<const double> values) {
  state_->write_pixels(first, values);
}

void FitsWriter::write_column(std::size_t column, std::int64_t first_row, std::span<const double> values) {
  state_->write_column(column, first_row, values);
}
void FitsWriter::write_column(std::size_t column, std::int64_t first_row, std::span<const float> values) {
  state_->write_column(column, first_row, values);
}
void FitsWriter::write_column(std::size_t column, std::int64_t first_row, std::span<const std::int32_t> values) {
  state_->write_column(column, first_row, values);
}
void FitsWriter::write_column(std::size_t column, std::int64_t first_row, std::span<const std::int64_t> values) {
  state_->write_column(column, first_row, values);
}
void FitsWriter::write_column(std::size_t column, std::int64_t first_row, std::span<const std::string> values) {
  const int width = state_->column_width(column);
  if (values.empty()) return;
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const std::string& value : values) {
    ASTROID_CHECK_LE(value.size(), static_cast<std::size_t>(width));
    texts.push_back(printable_ascii(value));
  }
  std::vector<char*> pointers;
  pointers.reserve(texts.size());
  for (std::string& text : texts) pointers.push_back(text.data());
  state_->call(&ffpcls, static_cast<int>(column) + 1, LONGLONG{first_row + 1}, LONGLONG{1},
               static_cast<LONGLONG>(pointers.size()), pointers.data());
}

void FitsWriter::commit(Durability durability) {
  State& s = *state_;
  if (s.units.empty()) throw BugError("FitsWriter: nothing was written to " + s.path.string());
  const std::string partial = partial_path(s.path).string();
  const auto check = [&](int status) {
    if (status != 0) throw EnvironmentError(s.path.string(), cfitsio_message(status, errno));
  };
  s.seal();
  try {
    const CfitsioLock lock;
    int status = 0;
    errno = 0;
    fits_close_file(std::exchange(s.file, nullptr), &status);  // gone even when it fails
    check(status);
    // Opened anew, for only now is it settled where everything lies.
    std::vector<FitsUnitExtent> extents;
    fits_open_diskfile(&s.file, partial.c_str(), READONLY, &status);
    check(status);
    for (int number = 1; number <= static_cast<int>(s.units.size()); ++number) {
      LONGLONG header = 0;
      LONGLONG data = 0;
      LONGLONG end = 0;
      s.call(&ffmahd, number, static_cast<int*>(nullptr));
      s.call(&ffghadll, &header, &data, &end);
      extents.push_back({header, data, end});
    }
    fits_close_file(std::exchange(s.file, nullptr), &status);
    check(status);
    s.attempt([&] {
      write_fits_checksums(s.descriptor, extents);
      if (durability == Durability::kAtOnce && ::fsync(s.descriptor) != 0)
        throw std::system_error(errno, std::generic_category());
      if (::close(std::exchange(s.descriptor, -1)) != 0) throw std::system_error(errno, std::generic_category());
    });
    rename_complete(partial, s.path, durability);
  } catch (...) {
    s.discard();
    throw;
  }
}

}  // namespace astroid
