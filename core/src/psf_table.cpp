#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/fits_reader.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {

namespace {

// Reads the keywords of one image, collecting what is wrong with them.
class TableHeader {
 public:
  TableHeader(const FitsReader& fits, int unit) : fits_(fits), unit_(unit) {}

  double samples_per_pixel() {
    for (const char* key : {"SUBPIX", "PIXSAMP"}) {
      if (const auto value = fits_.number(unit_, key)) return positive(key, *value);
    }
    const auto step = fits_.number(unit_, "CDELT1");
    if (!step) {
      refuse("SUBPIX", "", "samples per pixel in SUBPIX or PIXSAMP, or pixels per sample in CDELT1",
             "the scale of the PSF table is missing");
      return 1.0;
    }
    const std::string scale_unit = fits_.text(unit_, "CUNIT1").value_or("pixel");
    if (scale_unit != "pixel" && scale_unit != "px" && scale_unit != "pix") {
      refuse("CUNIT1", scale_unit, "pixel, or the keyword SUBPIX", "the step of the PSF table is not in pixels");
    }
    const double other = fits_.number(unit_, "CDELT2").value_or(*step);
    if (other != *step) {
      refuse("CDELT2", fmt::format("{}", other), fmt::format("CDELT1, {}", *step),
             "the samples of the PSF table are not square");
    }
    return 1.0 / positive("CDELT1", *step);
  }

  // 0-based.
  double centre(const char* key, int samples) {
    const auto pixel = fits_.number(unit_, key);
    const double centre = pixel ? *pixel - 1.0 : 0.5 * (samples - 1);
    if (!(centre >= -0.5 && centre <= samples - 0.5)) {
      refuse(key, fmt::format("{}", *pixel), fmt::format("0.5 to {}", samples + 0.5),
             "the origin of the PSF is outside its table");
    }
    return centre;
  }

  void refuse(std::string key, std::string value, std::string expected, std::string message) {
    problems_.push_back({.file = fits_.file(),
                         .parameter = std::move(key),
                         .value = std::move(value),
                         .expected = std::move(expected),
                         .message = std::move(message)});
  }

  void throw_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  double positive(const char* key, double value) {
    if (value > 0.0 && std::isfinite(value)) return value;
    refuse(key, fmt::format("{}", value), "a positive number", "the scale of the PSF table is not usable");
    return 1.0;
  }

  const FitsReader& fits_;
  int unit_;
  std::vector<Problem> problems_;
};

}  // namespace

namespace {

PsfTable read_table(const FitsReader& fits, int unit, TableHeader& header) {
  PsfTable table;
  table.samples = fits.read_image<double, unit::Relative>(unit);
  table.samples_per_pixel = header.samples_per_pixel();
  table.centre_x = header.centre("CRPIX1", table.samples.nx());
  table.centre_y = header.centre("CRPIX2", table.samples.ny());
  const auto samples = table.samples.pixels();
  const auto bad = std::count_if(samples.begin(), samples.end(), [](double v) { return !std::isfinite(v); });
  if (bad > 0) {
    header.refuse("image", fmt::format("{} samples", bad), "finite samples", "the PSF table has holes");
  }
  return table;
}

}  // namespace

PsfTable read_psf_table(const std::string& path) {
  const FitsReader fits(path);
  const int unit = fits.first_image();
  TableHeader header(fits, unit);
  PsfTable table = read_table(fits, unit, header);
  header.throw_problems();
  return table;
}

std::vector<FieldPsfTable> read_field_psf(const std::string& path) {
  const FitsReader fits(path);
  static_cast<void>(fits.first_image());  // says what is wrong with a file that has none
  std::vector<FieldPsfTable> tables;
  for (std::size_t i = 0; i < fits.units().size(); ++i) {
    const FitsUnit& unit = fits.units()[i];
    if (unit.axes.size() != 2) continue;
    const int number = static_cast<int>(i) + 1;
    TableHeader header(fits, number);
    FieldPsfTable table{.position = {}, .table = read_table(fits, number, header)};
    for (const char* key : {"FIELDX", "FIELDY"}) {
      const auto value = fits.number(number, key);
      if (!value)
        header.refuse(key, "", "the table's place on the detector, 0-based pixels",
                      fmt::format("image {} of the PSF file has no place", number));
      (key[5] == 'X' ? table.position.x : table.position.y) = value.value_or(0.0);
    }
    header.throw_problems();
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace astroid
