#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/photometry/light_curves.hpp"

namespace astroid {

namespace {

constexpr int kPrimary = 1;

[[noreturn]] void refuse(const FitsReader& reader, std::string parameter, std::string value, std::string message,
                         std::string expected) {
  Problem problem;
  problem.file = reader.file();
  problem.parameter = std::move(parameter);
  problem.value = std::move(value);
  problem.message = std::move(message);
  problem.expected = std::move(expected);
  throw InputError(std::move(problem));
}

constexpr const char* kExpectedFile = "photometry/lightcurves.fits of an ASTROID run";

int unit_named(const FitsReader& reader, const std::string& name) {
  const auto unit = reader.find_unit(name);
  if (!unit) refuse(reader, "", "", fmt::format("not a light-curve file: it has no unit {}", name), kExpectedFile);
  return *unit;
}

double number_of(const FitsReader& reader, const char* key) {
  const auto value = reader.number(kPrimary, key);
  if (!value) refuse(reader, key, "", "not a light-curve file: the keyword is missing", kExpectedFile);
  return *value;
}

std::size_t column_of(const FitsReader& reader, int unit, const char* name) {
  const auto column = reader.find_column(unit, name);
  if (!column) refuse(reader, name, "", "not a light-curve file: the column is missing", kExpectedFile);
  return *column;
}

LightCurveHeader read_header(const FitsReader& reader) {
  LightCurveHeader header;
  header.cameras = static_cast<int>(number_of(reader, "CAMERAS"));
  header.exposures = static_cast<std::int64_t>(number_of(reader, "EXPOSURE"));
  header.cycle = number_of(reader, "CYCLE");
  header.exposure_time = number_of(reader, "EXPTIME");
  header.start_mjd = number_of(reader, "MJD-BEG");
  header.history = reader.history(kPrimary);
  return header;
}

std::vector<LightCurveStar> read_stars(const FitsReader& reader) {
  const int unit = unit_named(reader, "STARS");
  const auto ids = reader.read_texts(unit, column_of(reader, unit, "ID"));
  const auto magnitude = reader.read_numbers(unit, column_of(reader, unit, "MAG"));
  const auto x = reader.read_numbers(unit, column_of(reader, unit, "X"));
  const auto y = reader.read_numbers(unit, column_of(reader, unit, "Y"));
  const auto reference = reader.read_numbers(unit, column_of(reader, unit, "REFERENCE"));
  const auto nsr = reader.read_numbers(unit, column_of(reader, unit, "NSR"));
  const auto flags = reader.read_integers(unit, column_of(reader, unit, "FLAGS"));
  std::vector<LightCurveStar> stars;
  stars.reserve(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
    stars.push_back({ids[i], magnitude[i], x[i], y[i], reference[i], nsr[i], static_cast<std::uint32_t>(flags[i])});
  return stars;
}

// Flags of one star, of one camera or (0) of all.
void add_sparse_flags(const FitsReader& reader, std::size_t star, int camera, std::vector<std::uint32_t>& flags) {
  const int unit = unit_named(reader, "FLAGS");
  const auto cameras = reader.read_integers(unit, column_of(reader, unit, "CAMERA"));
  const auto stars = reader.read_integers(unit, column_of(reader, unit, "STAR"));
  const auto exposures = reader.read_integers(unit, column_of(reader, unit, "CADENCENO"));
  const auto count = reader.read_integers(unit, column_of(reader, unit, "EXPOSURES"));
  const auto bits = reader.read_integers(unit, column_of(reader, unit, "FLAGS"));
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const bool mine = stars[i] == static_cast<std::int64_t>(star) && (camera == 0 || cameras[i] == camera);
    if (!mine || exposures[i] < 0 || count[i] < 0) continue;
    const auto first = std::min(flags.size(), static_cast<std::size_t>(exposures[i]));
    const auto last = first + std::min(flags.size() - first, static_cast<std::size_t>(count[i]));
    for (std::size_t k = first; k < last; ++k) flags[k] |= static_cast<std::uint32_t>(bits[i]);
  }
}

}  // namespace

LightCurveContents read_light_curve_contents(const std::string& path) {
  const FitsReader reader(path);
  return {read_header(reader), read_stars(reader)};
}

LightCurve read_light_curve(const std::string& path, const std::string& id, int camera) {
  const FitsReader reader(path);
  const LightCurveHeader header = read_header(reader);
  const std::vector<LightCurveStar> stars = read_stars(reader);
  const auto found = std::find_if(stars.begin(), stars.end(), [&id](const LightCurveStar& s) { return s.id == id; });
  if (found == stars.end())
    refuse(reader, "star", id, "the file has no such star",
           fmt::format("one of the {} in its table STARS", stars.size()));
  if (camera < 0 || camera > header.cameras)
    refuse(reader, "camera", fmt::format("{}", camera), "the file has no such camera",
           fmt::format("1 to {}, or 0 for their mean", header.cameras));
  const bool mean = camera == 0 && header.cameras > 1;
  const int unit = unit_named(reader, mean ? "COMBINED" : fmt::format("CAMERA{}", std::max(camera, 1)));

  LightCurve curve;
  curve.star = *found;
  const auto star = static_cast<std::size_t>(found - stars.begin());
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(header.exposures, 0));
  std::vector<float> deviation(count);
  if (count > 0) reader.read_pixels(unit, static_cast<std::int64_t>(star) * header.exposures, deviation);
  curve.flags.assign(count, curve.star.flags);
  add_sparse_flags(reader, star, camera, curve.flags);
  for (std::size_t k = 0; k < count; ++k) {
    curve.time.push_back(mid_exposure(header, static_cast<std::int64_t>(k)));
    curve.flux.push_back(curve.star.reference * (1.0 + static_cast<double>(deviation[k])));
  }
  return curve;
}

}  // namespace astroid
