#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "astroid/core/effective_psf.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/fits_reader.hpp"
#include "astroid/core/fits_writer.hpp"

namespace astroid {

namespace {

constexpr const char* kType = "EFFECTIVE";

class Keywords {
 public:
  Keywords(const FitsReader& fits, int unit) : fits_(fits), unit_(unit) {}

  double number(const char* key, double least, double most, const char* expected) {
    const std::optional<double> value = fits_.number(unit_, key);
    if (value && *value >= least && *value <= most) return *value;
    refuse(key, value ? fmt::format("{}", *value) : std::string(), expected);
    return least;
  }
  int whole(const char* key, int least, int most, const char* expected) {
    const double value = number(key, least, most, expected);
    if (value != std::floor(value)) refuse(key, fmt::format("{}", value), expected);
    return static_cast<int>(value);
  }
  void refuse(const char* key, std::string value, std::string expected) {
    problems_.push_back({.file = fits_.file(),
                         .parameter = key,
                         .value = std::move(value),
                         .expected = std::move(expected),
                         .message = "the effective PSF is not usable"});
  }
  void throw_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  const FitsReader& fits_;
  int unit_;
  std::vector<Problem> problems_;
};

}  // namespace

bool is_effective_psf(const std::filesystem::path& file) {
  const FitsReader fits(file);
  return !fits.units().empty() && fits.text(1, "PSFTYPE").value_or("") == kType;
}

void write_effective_psf(const std::filesystem::path& file, const EffectivePsf& psf) {
  FitsWriter fits(file);
  const std::int64_t side = psf.side();
  fits.begin_image(FitsNumber::kFloat64, {side, side, static_cast<std::int64_t>(psf.terms())});
  const auto reference = static_cast<double>(psf.half + 1);
  fits.card({"PSFTYPE", std::string(kType), "fraction of a star in a pixel at an offset"});
  fits.card({"SUBPIX", std::int64_t{psf.samples_per_pixel}, "samples per pixel"});
  fits.card({"CRPIX1", reference, "the star"});
  fits.card({"CRPIX2", reference, "the star"});
  fits.card({"PSFORDER", std::int64_t{psf.order}, "planes: 1, u, v, u^2, u v, v^2"});
  fits.card({"FIELDX", psf.field_centre.x, "[px] 0-based; u = (x - FIELDX) / FIELDSX"});
  fits.card({"FIELDY", psf.field_centre.y, "[px] 0-based; v = (y - FIELDY) / FIELDSY"});
  fits.card({"FIELDSX", psf.field_scale.x, "[px]"});
  fits.card({"FIELDSY", psf.field_scale.y, "[px]"});
  for (std::size_t k = 0; k < psf.terms(); ++k) {
    const auto begin = psf.coefficients.begin() + static_cast<std::ptrdiff_t>(k * psf.plane_size());
    std::vector<double> plane(begin, begin + static_cast<std::ptrdiff_t>(psf.plane_size()));
    spline_values_of(plane, psf.side());
    fits.write_pixels(static_cast<std::int64_t>(k * psf.plane_size()), plane);
  }
  fits.commit();
}

EffectivePsf read_effective_psf(const std::filesystem::path& file) {
  const FitsReader fits(file);
  constexpr int kUnit = 1;
  Keywords keywords(fits, kUnit);
  EffectivePsf psf;
  constexpr int kMostSamples = 1000;
  constexpr double kFarthest = 1e9;  // px
  psf.samples_per_pixel = keywords.whole("SUBPIX", 1, kMostSamples, "a whole number of samples per pixel, 1 to 1000");
  psf.order = keywords.whole("PSFORDER", 0, 2, "0, 1 or 2");
  psf.field_centre.x = keywords.number("FIELDX", -kFarthest, kFarthest, "a pixel coordinate");
  psf.field_centre.y = keywords.number("FIELDY", -kFarthest, kFarthest, "a pixel coordinate");
  constexpr double kSmallest = 1e-3;  // px
  psf.field_scale.x = keywords.number("FIELDSX", kSmallest, kFarthest, "a positive number of pixels");
  psf.field_scale.y = keywords.number("FIELDSY", kSmallest, kFarthest, "a positive number of pixels");
  constexpr std::int64_t kMostSide = std::int64_t{10} * kMostSamples;
  const auto& axes = fits.units().front().axes;
  const std::int64_t terms = axes.size() > 2 ? axes[2] : 1;
  const bool square = axes.size() >= 2 && axes.size() <= 3 && axes[0] == axes[1] && axes[0] % 2 == 1 && axes[0] > 2 &&
                      axes[0] < kMostSide && terms == static_cast<std::int64_t>(psf.terms());
  if (!square) {
    keywords.refuse("NAXIS", fits.units().front().text(),
                    fmt::format("planes with as many columns as rows, an odd number, and {} of them", psf.terms()));
    keywords.throw_problems();
  }
  psf.half = static_cast<int>(axes[0] / 2);
  for (const char* key : {"CRPIX1", "CRPIX2"}) {
    const double centre = psf.half + 1.0;
    keywords.number(key, centre, centre, fmt::format("{}, the middle of the grid", centre).c_str());
  }
  psf.coefficients.resize(psf.terms() * psf.plane_size());
  for (std::size_t k = 0; k < psf.terms(); ++k) {
    std::vector<double> plane(psf.plane_size());
    fits.read_pixels(kUnit, static_cast<std::int64_t>(k * psf.plane_size()), plane);
    const auto bad = std::ranges::count_if(plane, [](double v) { return !std::isfinite(v); });
    if (bad > 0) keywords.refuse("image", fmt::format("{} samples without a value", bad), "finite samples");
    spline_coefficients_of(plane, psf.side());
    std::ranges::copy(plane, psf.coefficients.begin() + static_cast<std::ptrdiff_t>(k * psf.plane_size()));
  }
  keywords.throw_problems();
  return psf;
}

}  // namespace astroid
