#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Groups of cameras; 0 where all cameras are alike.
int group_count(const FitsReader& reader) {
  return static_cast<int>(reader.number(kPrimary, "GROUPS").value_or(0.0));
}

LightCurveHeader read_header(const FitsReader& reader) {
  LightCurveHeader header;
  header.cameras = static_cast<int>(number_of(reader, "CAMERAS"));
  header.exposures = static_cast<std::int64_t>(number_of(reader, "EXPOSURE"));
  header.cycle = number_of(reader, "CYCLE");
  header.exposure_time = number_of(reader, "EXPTIME");
  header.start_mjd = number_of(reader, "MJD-BEG");
  header.is_corrected = reader.find_unit("ATTITUDE1").has_value();
  header.has_responses = reader.find_column(unit_named(reader, "STARS"), "RYAW").has_value();
  header.line_time = reader.number(kPrimary, "LINETIME").value_or(0.0);
  header.history = reader.history(kPrimary);
  const int groups = group_count(reader);
  for (int camera = 1; groups > 0 && camera <= header.cameras; ++camera) {
    const int unit = unit_named(reader, fmt::format("CAMERA{}", camera));
    const auto group = reader.number(unit, "GROUP");
    const auto stagger = reader.number(unit, "STAGGER");
    if (!group || !stagger || !(*group >= 1.0 && *group <= groups))
      refuse(reader, "GROUP", fmt::format("CAMERA{}", camera), "the camera names no group of the file",
             fmt::format("a group from 1 to {}, and STAGGER", groups));
    header.group.push_back(static_cast<int>(*group) - 1);
    header.stagger.push_back(*stagger);
  }
  return header;
}

/// Responses to the attitude, where light curves were corrected for it.
std::vector<AttitudeResponse> read_responses(const FitsReader& reader, int unit, std::size_t stars) {
  std::vector<AttitudeResponse> responses(stars);
  if (!reader.find_column(unit, "RYAW")) return responses;
  const auto read = [&](const char* name, double AttitudeResponse::*axis) {
    const std::vector<double> values = reader.read_numbers(unit, column_of(reader, unit, name));
    for (std::size_t i = 0; i < stars; ++i) responses[i].*axis = values[i];
  };
  read("RYAW", &AttitudeResponse::yaw);
  read("RPITCH", &AttitudeResponse::pitch);
  read("RROLL", &AttitudeResponse::roll);
  return responses;
}

std::vector<LightCurveStar> read_stars(const FitsReader& reader, const std::string& table) {
  const int unit = unit_named(reader, table);
  const auto ids = reader.read_texts(unit, column_of(reader, unit, "ID"));
  const auto magnitude = reader.read_numbers(unit, column_of(reader, unit, "MAG"));
  const auto x = reader.read_numbers(unit, column_of(reader, unit, "X"));
  const auto y = reader.read_numbers(unit, column_of(reader, unit, "Y"));
  const auto reference = reader.read_numbers(unit, column_of(reader, unit, "REFERENCE"));
  const auto nsr = reader.read_numbers(unit, column_of(reader, unit, "NSR"));
  const auto flags = reader.read_integers(unit, column_of(reader, unit, "FLAGS"));
  std::vector<LightCurveStar> stars;
  stars.reserve(ids.size());
  const std::vector<AttitudeResponse> responses = read_responses(reader, unit, ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
    stars.push_back(
        {ids[i], magnitude[i], x[i], y[i], reference[i], nsr[i], static_cast<std::uint32_t>(flags[i]), responses[i]});
  return stars;
}

// The table FLAGS, whose rows are in the order of camera, star and exposure: so a search finds those of one star
// without reading the others, of which there can be millions.
class FlagTable {
 public:
  explicit FlagTable(const FitsReader& reader)
      : reader_(reader),
        unit_(unit_named(reader, "FLAGS")),
        rows_(reader.units()[static_cast<std::size_t>(unit_) - 1].rows),
        camera_(column_of(reader, unit_, "CAMERA")),
        star_(column_of(reader, unit_, "STAR")),
        exposure_(column_of(reader, unit_, "CADENCENO")),
        length_(column_of(reader, unit_, "EXPOSURES")),
        flags_(column_of(reader, unit_, "FLAGS")) {}

  // Adds those of one star and camera to the flags of its exposures.
  void add(int camera, std::size_t star, std::vector<std::uint32_t>& flags) const {
    const auto number = static_cast<std::int64_t>(star);
    const std::int64_t first = first_not_before(camera, number);
    const std::int64_t rows = first_not_before(camera, number + 1) - first;
    const std::vector<std::int64_t> exposures = reader_.read_integers(unit_, exposure_, first, rows);
    const std::vector<std::int64_t> lengths = reader_.read_integers(unit_, length_, first, rows);
    const std::vector<std::int64_t> bits = reader_.read_integers(unit_, flags_, first, rows);
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (exposures[i] < 0 || lengths[i] < 0) continue;
      const auto begin = std::min(flags.size(), static_cast<std::size_t>(exposures[i]));
      const auto end = begin + std::min(flags.size() - begin, static_cast<std::size_t>(lengths[i]));
      for (std::size_t k = begin; k < end; ++k) flags[k] |= static_cast<std::uint32_t>(bits[i]);
    }
  }

 private:
  [[nodiscard]] std::int64_t first_not_before(std::int64_t camera, std::int64_t star) const {
    std::int64_t low = 0;
    std::int64_t high = rows_;
    while (low < high) {
      const std::int64_t middle = low + (high - low) / 2;
      const std::int64_t its_camera = reader_.read_integers(unit_, camera_, middle, 1).front();
      const std::int64_t its_star = reader_.read_integers(unit_, star_, middle, 1).front();
      if (std::pair(its_camera, its_star) < std::pair(camera, star)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

  const FitsReader& reader_;
  int unit_;
  std::int64_t rows_;
  std::size_t camera_, star_, exposure_, length_, flags_;
};

LightCurveContents read_contents(const FitsReader& reader) {
  LightCurveContents contents{read_header(reader), read_stars(reader, "STARS")};
  for (int g = 1; g <= group_count(reader); ++g) {
    contents.groups.push_back(read_stars(reader, fmt::format("STARS{}", g)));
    if (contents.groups.back().size() != contents.stars.size())
      refuse(reader, fmt::format("STARS{}", g), "", "does not have the stars of STARS", kExpectedFile);
  }
  return contents;
}

}  // namespace

struct LightCurveReader::Impl {
  explicit Impl(const std::string& path) : reader(path), contents(read_contents(reader)), flags(reader) {}

  FitsReader reader;
  LightCurveContents contents;
  FlagTable flags;
};

LightCurveReader::LightCurveReader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}

LightCurveReader::~LightCurveReader() = default;

const LightCurveContents& LightCurveReader::contents() const {
  return impl_->contents;
}

LightCurve LightCurveReader::read(std::size_t star, int camera) const {
  const FitsReader& reader = impl_->reader;
  const auto& [header, stars, groups] = impl_->contents;
  if (star >= stars.size())
    refuse(reader, "star", fmt::format("number {}", star), "the file has no such star",
           fmt::format("one of the {} in its table STARS", stars.size()));
  if (camera < 0 || camera > header.cameras)
    refuse(reader, "camera", fmt::format("{}", camera), "the file has no such camera",
           fmt::format("1 to {}, or 0 for their mean", header.cameras));
  const bool mean = camera == 0 && header.cameras > 1;
  const int unit = unit_named(reader, mean ? "COMBINED" : fmt::format("CAMERA{}", std::max(camera, 1)));

  LightCurve curve;
  const bool of_group = camera > 0 && !groups.empty();
  curve.star = of_group ? groups[static_cast<std::size_t>(header.group[static_cast<std::size_t>(camera) - 1])][star]
                        : stars[star];
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(header.exposures, 0));
  std::vector<float> deviation(count);
  if (count > 0) reader.read_pixels(unit, static_cast<std::int64_t>(star) * header.exposures, deviation);
  curve.flags.assign(count, curve.star.flags);
  const int first_camera = std::max(camera, 1);
  const int last_camera = mean ? header.cameras : first_camera;
  for (int c = first_camera; c <= last_camera; ++c) impl_->flags.add(c, star, curve.flags);
  for (std::size_t k = 0; k < count; ++k) {
    curve.time.push_back(mid_exposure(header, static_cast<std::int64_t>(k), mean ? 0 : camera));
    curve.flux.push_back(curve.star.reference * (1.0 + static_cast<double>(deviation[k])));
  }
  return curve;
}

LightCurve LightCurveReader::read(const std::string& id, int camera) const {
  const std::vector<LightCurveStar>& stars = impl_->contents.stars;
  const auto found = std::find_if(stars.begin(), stars.end(), [&id](const LightCurveStar& s) { return s.id == id; });
  if (found == stars.end())
    refuse(impl_->reader, "star", id, "the file has no such star",
           fmt::format("one of the {} in its table STARS", stars.size()));
  return read(static_cast<std::size_t>(found - stars.begin()), camera);
}

std::vector<Attitude> LightCurveReader::attitudes(int camera) const {
  if (!impl_->contents.header.is_corrected) return {};
  const FitsReader& reader = impl_->reader;
  const int unit = unit_named(reader, fmt::format("ATTITUDE{}", camera));
  const std::vector<double> yaw = reader.read_numbers(unit, column_of(reader, unit, "YAW"));
  const std::vector<double> pitch = reader.read_numbers(unit, column_of(reader, unit, "PITCH"));
  const std::vector<double> roll = reader.read_numbers(unit, column_of(reader, unit, "ROLL"));
  std::vector<Attitude> attitudes;
  for (std::size_t k = 0; k < yaw.size(); ++k) attitudes.push_back({yaw[k], pitch[k], roll[k]});
  return attitudes;
}

LightCurveContents read_light_curve_contents(const std::string& path) {
  return read_contents(FitsReader(path));
}

LightCurve read_light_curve(const std::string& path, const std::string& id, int camera) {
  return LightCurveReader(path).read(id, camera);
}

}  // namespace astroid
