#include "astroid/sim/bad_pixel_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/core/readout_nodes.hpp"
#include "named_columns.hpp"

namespace astroid {

namespace {

constexpr std::size_t kMostProblems = 20;  // of one file: then the rest is like them
constexpr const char* kParameter = "CCD/BadPixels/File";

bool is_fits(const std::string& path) {
  std::array<char, 6> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  const std::string_view text(start.data(), start.size());
  constexpr std::string_view kGzip = "\x1f\x8b";
  return text == "SIMPLE" || text.starts_with(kGzip);
}

/// The pixel of a column defect and all that are moved through it.
void add_column(const Mission& mission, int x, int y, std::vector<DeadPixel>& dead) {
  const Rectangle detector{0, 0, mission.ccd.columns, mission.ccd.rows};
  const bool is_cmos = mission.simulation.type == DetectorType::kCmos;
  const ReadoutNodes nodes(detector, is_cmos ? 1 : mission.ccd.nodes.count);
  const Rectangle half = nodes.half(detector, nodes.half_of(y));
  const bool upwards = nodes.half_of(y) == 1;
  const int first = is_cmos || upwards ? half.y0 : y;
  const int end = upwards ? y + 1 : half.y1();
  for (int row = first; row < end; ++row) dead.push_back({x, row});
}

BadPixelList read_table(const Mission& mission) {
  const CsvTable table = read_csv(mission.ccd.bad_pixels.file);
  std::vector<Problem> problems;
  constexpr std::array<const char*, 2> kNames{"x", "y"};
  const auto places = find_named_columns(table, kNames, "columns x, y and perhaps kind, rate_e_per_s", problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  const std::optional<std::size_t> kinds = table.column("kind");
  const std::optional<std::size_t> rates = table.column("rate_e_per_s");
  const Rectangle detector{0, 0, mission.ccd.columns, mission.ccd.rows};
  BadPixelList list;
  for (std::size_t row = 0; row < table.rows() && problems.size() < kMostProblems; ++row) {
    const auto numbers = finite_numbers(table, row, places, problems);
    if (!numbers) continue;
    std::array<int, 2> place{};
    bool good = true;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const double value = (*numbers)[i];
      const int size = i == 0 ? detector.nx : detector.ny;
      place[i] = static_cast<int>(std::clamp(value, -1.0, static_cast<double>(size)));
      if (value == std::floor(value) && place[i] >= 0 && place[i] < size) continue;
      problems.push_back(table.problem(row, *places[i], "is no pixel of the detector",
                                       fmt::format("a whole number from 0 to {}", size - 1)));
      good = false;
    }
    const std::string_view kind = kinds ? table.field(row, *kinds) : std::string_view();
    if (!kind.empty() && kind != "dead" && kind != "hot" && kind != "column") {
      problems.push_back(table.problem(row, *kinds, "is no kind of bad pixel", "dead, hot or column"));
      good = false;
    }
    ElectronsPerSecond rate = mission.ccd.bad_pixels.hot_current;
    if (kind == "hot" && rates && !table.field(row, *rates).empty()) {
      const std::optional<double> given = table.number(row, *rates);
      if (given && std::isfinite(*given) && *given >= 0.0) {
        rate = ElectronsPerSecond(*given);
      } else {
        problems.push_back(table.problem(row, *rates, "is no dark current", "a number of e-/s, at least 0"));
        good = false;
      }
    }
    if (!good) continue;
    if (kind == "hot")
      list.hot.push_back({place[0], place[1], rate});
    else if (kind == "column")
      add_column(mission, place[0], place[1], list.dead);
    else
      list.dead.push_back({place[0], place[1]});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return list;
}

BadPixelList read_mask(const Mission& mission) {
  const std::string& path = mission.ccd.bad_pixels.file;
  const CcdSettings& ccd = mission.ccd;
  const FitsReader reader(path);
  const int unit = reader.first_image();
  const FitsUnit& image = reader.units()[static_cast<std::size_t>(unit) - 1];
  if (image.axes != std::vector<std::int64_t>{ccd.columns, ccd.rows})
    throw InputError(Problem{.file = path,
                             .parameter = kParameter,
                             .expected = fmt::format("an image of the detector, {} x {} px", ccd.columns, ccd.rows),
                             .message = fmt::format("holds {}", image.text())});
  const auto mask = reader.read_image<float, unit::Flags>(unit);
  BadPixelList list;
  std::vector<Problem> problems;
  for (int y = 0; y < ccd.rows; ++y)
    for (int x = 0; x < ccd.columns; ++x) {
      const float value = mask.at(x, y);
      if (value == 0.0F) continue;
      if (value == 1.0F) {
        list.dead.push_back({x, y});
      } else if (value == 2.0F) {
        list.hot.push_back({x, y, ccd.bad_pixels.hot_current});
      } else if (problems.size() < kMostProblems) {
        problems.push_back({.file = path,
                            .parameter = fmt::format("pixel ({}, {})", x, y),
                            .value = fmt::format("{}", value),
                            .expected = "0 good, 1 dead or 2 hot",
                            .message = "is no kind of pixel"});
      }
    }
  if (!problems.empty()) throw InputError(std::move(problems));
  return list;
}

}  // namespace

BadPixelList read_bad_pixels(const Mission& mission) {
  const std::string& path = mission.ccd.bad_pixels.file;
  if (path.empty()) return {};
  return is_fits(path) ? read_mask(mission) : read_table(mission);
}

}  // namespace astroid
