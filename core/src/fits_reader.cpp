#include "astroid/core/fits_reader.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

#include "fits_file.hpp"

namespace astroid {

namespace {

// How much larger than the file an image compressed by tiles may be: Rice needs at least a bit for 32 equal pixels of 8
// bytes, so a header that promises more is damaged.
constexpr double kLargestCompression = 2048.0;
constexpr double kBitsPerByte = 8.0;

bool equal_but_for_case(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::toupper(static_cast<unsigned char>(x)) == std::toupper(static_cast<unsigned char>(y));
  });
}

/// Whether a file begins with the card that every FITS file begins with.
bool begins_like_fits(const std::string& path) {
  constexpr std::string_view kFirstCard = "SIMPLE  =";
  std::string begin(kFirstCard.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kFirstCard;
}

}  // namespace

std::string FitsUnit::text() const {
  if (kind == Kind::kTable) return fmt::format("a table of {} rows", rows);
  if (axes.empty()) return "a header without data";
  std::string result = "an image of ";
  for (std::size_t i = 0; i < axes.size(); ++i) result += fmt::format("{}{}", i > 0 ? " x " : "", axes[i]);
  return result + " px";
}

FitsReader::State::~State() {
  if (file == nullptr) return;
  const CfitsioLock lock;
  int ignored = 0;
  fits_close_file(file, &ignored);
  fits_clear_errmsg();
}

std::string FitsReader::State::unit_text(int unit) const {
  const FitsUnit& u = units[static_cast<std::size_t>(unit) - 1];
  return u.name.empty() ? fmt::format("unit {} ({})", unit, u.text())
                        : fmt::format("unit {} ({}, {})", unit, u.name, u.text());
}

void FitsReader::State::go_to(int unit) const {
  if (unit < 1 || static_cast<std::size_t>(unit) > units.size()) {
    throw refuse(fmt::format("has no unit {}", unit), fmt::format("one of its units 1 to {}", units.size()));
  }
  call(&ffmahd, unit, static_cast<int*>(nullptr));
}

const FitsUnit& FitsReader::State::go_to(int unit, FitsUnit::Kind kind) const {
  go_to(unit);
  const FitsUnit& u = units[static_cast<std::size_t>(unit) - 1];
  if (u.kind != kind || (kind == FitsUnit::Kind::kImage && u.axes.empty())) {
    throw refuse(unit_text(unit) + " cannot be used", kind == FitsUnit::Kind::kImage ? "an image" : "a table");
  }
  // Does the file hold what the header promises? In floating point, for the product may exceed any integer.
  double bytes = 0.0;
  double limit = static_cast<double>(file->Fptr->filesize);
  if (kind == FitsUnit::Kind::kImage) {
    int bits = 0;
    call(&ffgidt, &bits);
    bytes = std::abs(bits) / kBitsPerByte;
    for (const std::int64_t axis : u.axes) bytes *= static_cast<double>(axis);
  } else {
    LONGLONG width = 0;
    call(&ffgkyjj, "NAXIS1", &width, static_cast<char*>(nullptr));
    bytes = static_cast<double>(width) * static_cast<double>(u.rows);
  }
  const CfitsioLock lock;
  int status = 0;
  if (kind == FitsUnit::Kind::kImage && fits_is_compressed_image(file, &status) != 0) {
    limit *= kLargestCompression;
  } else {
    LONGLONG data_start = 0;
    fits_get_hduaddrll(file, nullptr, &data_start, nullptr, &status);
    limit -= static_cast<double>(data_start);
  }
  if (!(bytes <= limit)) {
    throw refuse(fmt::format("is truncated: {} needs {:.0f} bytes of data, the file has {:.0f}", unit_text(unit), bytes,
                             std::max(limit, 0.0)),
                 "a complete FITS file");
  }
  return u;
}

FitsReader::FitsReader(const std::filesystem::path& path) : state_(std::make_unique<State>(path.string())) {
  State& s = *state_;
  const auto cause = [](int number) { return std::generic_category().message(number); };
  if (::access(path.c_str(), R_OK) != 0) throw EnvironmentError(s.path, cause(errno));
  if (std::filesystem::is_directory(path)) throw EnvironmentError(s.path, cause(EISDIR));
  if (std::filesystem::is_regular_file(path) && std::filesystem::file_size(path) == 0)
    throw s.refuse("is empty", "a FITS file");
  {
    const CfitsioLock lock;
    int status = 0;
    fits_open_diskfile(&s.file, s.path.c_str(), READONLY, &status);
    if (status != 0) {
      s.file = nullptr;
      if (begins_like_fits(s.path))
        throw s.refuse("is truncated or damaged: its header has no end", "a complete FITS file");
      throw s.refuse("is not a FITS file: " + cfitsio_message(status, 0), "a FITS file");
    }
  }
  for (int number = 1;; ++number) {
    int type = 0;
    const int status = s.attempt(&ffmahd, number, &type);
    if (status == END_OF_FILE || (status != 0 && number > 1))
      break;  // rubbish after the last unit is nobody's business
    if (status != 0) throw s.refuse("cannot be read: " + cfitsio_message(status, 0), "a FITS file");
    FitsUnit unit;
    if (type == IMAGE_HDU) {
      int axes = 0;
      s.call(&ffgidm, &axes);
      std::vector<LONGLONG> lengths(static_cast<std::size_t>(std::max(axes, 0)));
      if (axes > 0) s.call(&ffgiszll, axes, lengths.data());
      unit.axes.assign(lengths.begin(), lengths.end());
    } else {
      unit.kind = FitsUnit::Kind::kTable;
      LONGLONG rows = 0;
      s.call(&ffgnrwll, &rows);
      unit.rows = rows;
    }
    s.units.push_back(std::move(unit));
    s.units.back().name = text(number, "EXTNAME").value_or("");
  }
}

FitsReader::~FitsReader() = default;
FitsReader::FitsReader(FitsReader&&) noexcept = default;

const std::vector<FitsUnit>& FitsReader::units() const {
  return state_->units;
}
const std::string& FitsReader::file() const {
  return state_->path;
}

int FitsReader::first_image() const {
  for (std::size_t i = 0; i < units().size(); ++i) {
    if (units()[i].kind == FitsUnit::Kind::kImage && !units()[i].axes.empty()) return static_cast<int>(i) + 1;
  }
  throw state_->refuse("holds no image", "a FITS file with an image");
}

int FitsReader::first_table() const {
  for (std::size_t i = 0; i < units().size(); ++i) {
    if (units()[i].kind == FitsUnit::Kind::kTable) return static_cast<int>(i) + 1;
  }
  throw state_->refuse("holds no table", "a FITS file with a table");
}

std::optional<int> FitsReader::find_unit(const std::string& name) const {
  for (std::size_t i = 0; i < units().size(); ++i) {
    if (equal_but_for_case(units()[i].name, name)) return static_cast<int>(i) + 1;
  }
  return std::nullopt;
}

Rectangle FitsReader::whole_plane(int unit) const {
  const FitsUnit& u = state_->go_to(unit, FitsUnit::Kind::kImage);
  constexpr std::int64_t kLongest = std::numeric_limits<int>::max();
  if (u.axes.size() < 2 || u.axes[0] < 1 || u.axes[1] < 1 || u.axes[0] > kLongest || u.axes[1] > kLongest) {
    throw state_->refuse(state_->unit_text(unit) + " cannot be used", "a two-dimensional image");
  }
  return {0, 0, static_cast<int>(u.axes[0]), static_cast<int>(u.axes[1])};
}

Rectangle FitsReader::whole_image(int unit) const {
  const Rectangle plane = whole_plane(unit);
  const auto& axes = units()[static_cast<std::size_t>(unit) - 1].axes;
  if (std::any_of(axes.begin() + 2, axes.end(), [](std::int64_t axis) { return axis != 1; })) {
    throw state_->refuse(state_->unit_text(unit) + " cannot be used", "a two-dimensional image");
  }
  return plane;
}

void FitsReader::check_section(int unit, const Rectangle& section, std::int64_t plane) const {
  const Rectangle whole = whole_plane(unit);
  const auto& axes = units()[static_cast<std::size_t>(unit) - 1].axes;
  std::int64_t planes = 1;
  for (std::size_t i = 2; i < axes.size(); ++i) planes *= axes[i];
  if (plane < 0 || plane >= planes) {
    throw state_->refuse(fmt::format("{} has no plane {}", state_->unit_text(unit), plane),
                         fmt::format("a plane 0 to {}", planes - 1));
  }
  const Rectangle inside = intersect(whole, section);
  if (!(inside == section)) {
    throw state_->refuse(fmt::format("{} has no section of {} x {} px at ({}, {})", state_->unit_text(unit), section.nx,
                                     section.ny, section.x0, section.y0),
                         "a section inside the image");
  }
}

namespace {

template <class T>
constexpr int kTypeCode = sizeof(T) == sizeof(float) ? TFLOAT : TDOUBLE;

}  // namespace

void FitsReader::read_pixels(int unit, std::int64_t first, std::span<float> values) const {
  if (values.empty()) return;
  (void)state_->go_to(unit, FitsUnit::Kind::kImage);
  float missing = std::numeric_limits<float>::quiet_NaN();
  int any_missing = 0;
  state_->call(&ffgpv, kTypeCode<float>, LONGLONG{first + 1}, static_cast<LONGLONG>(values.size()), &missing,
               values.data(), &any_missing);
}

void FitsReader::read_pixels(int unit, std::int64_t first, std::span<double> values) const {
  if (values.empty()) return;
  (void)state_->go_to(unit, FitsUnit::Kind::kImage);
  double missing = std::numeric_limits<double>::quiet_NaN();
  int any_missing = 0;
  state_->call(&ffgpv, kTypeCode<double>, LONGLONG{first + 1}, static_cast<LONGLONG>(values.size()), &missing,
               values.data(), &any_missing);
}

void FitsReader::read_row(int unit, int x, int y, std::int64_t plane, std::span<float> values) const {
  const auto& axes = units()[static_cast<std::size_t>(unit) - 1].axes;
  read_pixels(unit, (plane * axes[1] + y) * axes[0] + x, values);
}

void FitsReader::read_row(int unit, int x, int y, std::int64_t plane, std::span<double> values) const {
  const auto& axes = units()[static_cast<std::size_t>(unit) - 1].axes;
  read_pixels(unit, (plane * axes[1] + y) * axes[0] + x, values);
}

}  // namespace astroid
