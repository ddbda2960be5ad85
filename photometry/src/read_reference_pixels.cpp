#include "read_reference_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "astroid/core/digitise.hpp"
#include "astroid/photometry/reference_pixels.hpp"

namespace astroid::detail {

namespace {

struct ReferenceImage {
  Image<float, unit::Adu> pixels;
  Rectangle area;  // in the coordinates of the image
};

/// Offset from detector to image coordinates.
std::pair<int, int> offset_of(const FitsReader& reader, int unit) {
  const auto whole = [&](const char* key) {
    return static_cast<int>(std::lround(reader.number(unit, key).value_or(0.0)));
  };
  return {whole("LTV1"), whole("LTV2")};
}

std::vector<ReferenceImage> read_all(const FitsReader& reader, int image_unit, const std::string& name) {
  std::vector<ReferenceImage> images;
  const auto [x_image, y_image] = offset_of(reader, image_unit);
  const auto& units = reader.units();
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (units[i].kind != FitsUnit::Kind::kImage || units[i].name != name || units[i].axes.size() != 2) continue;
    const int unit = static_cast<int>(i) + 1;
    auto pixels = reader.read_image<float, unit::Adu>(unit);
    const auto [x, y] = offset_of(reader, unit);
    const Rectangle area{x_image - x, y_image - y, pixels.nx(), pixels.ny()};
    images.push_back({std::move(pixels), area});
  }
  return images;
}

ReferenceNoise noise_of(const FrameHeader& header, double bias) {
  const double gain = header.gain.value();
  const double quantisation = 1.0 / kSqrt12;
  return {.readout = std::hypot(header.readout_noise.value() / gain, quantisation), .gain = gain, .bias = bias};
}

}  // namespace

std::optional<Adu> prescan_level(const FitsReader& reader, int image_unit, const FrameHeader& header) {
  std::vector<float> values;
  for (const ReferenceImage& image : read_all(reader, image_unit, "PRESCAN"))
    values.insert(values.end(), image.pixels.pixels().begin(), image.pixels.pixels().end());
  // Without light, so that the bias of the noise does not matter.
  const double level = reference_level(values, noise_of(header, std::numeric_limits<double>::max()));
  return std::isfinite(level) ? std::optional(Adu(level)) : std::nullopt;
}

void subtract_overscan(const FitsReader& reader, int image_unit, Frame& frame, std::vector<std::string>& notes) {
  const Rectangle image = frame.pixels.layout().regions()[0];
  const std::vector<ReferenceImage> found = read_all(reader, image_unit, "OVERSCAN");
  if (found.empty()) return;
  const auto find = [&](bool above) {
    const auto fits = [&](const ReferenceImage& o) {
      const bool beside = above ? o.area.y0 >= image.y1() : o.area.y1() <= image.y0;
      return beside && o.area.x0 <= image.x0 && o.area.x1() >= image.x1();
    };
    const auto place = std::ranges::find_if(found, fits);
    return place != found.end() ? &*place : nullptr;
  };
  const ReferenceImage* const above = find(true);
  const ReferenceImage* const below = find(false);
  if (above == nullptr) {
    notes.emplace_back("The OVERSCAN extension does not lie above the image (LTV1, LTV2) and was not used.");
    return;
  }
  const double level = frame.header.bias.value();
  const auto view = frame.pixels.view(0);
  const auto subtract = [&](const ReferenceImage& overscan, int y0, int y1) {
    std::vector<double> levels(static_cast<std::size_t>(overscan.area.nx));
    column_levels(overscan.pixels.view(), noise_of(frame.header, level), levels);
    const auto first = static_cast<std::size_t>(image.x0 - overscan.area.x0);
    for (int y = std::max(y0, image.y0); y < std::min(y1, image.y1()); ++y) {
      const std::span<float> row = view.row(y);
      for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = static_cast<float>(static_cast<double>(row[i]) - (levels[first + i] - level));
    }
  };
  // Overscan on both sides: the halves of a column are read in opposite directions, and meet in the middle between.
  const int middle = below != nullptr ? below->area.y1() + (above->area.y0 - below->area.y1() + 1) / 2 : image.y0;
  if (below != nullptr) subtract(*below, image.y0, middle);
  subtract(*above, middle, image.y1());
  notes.push_back(
      fmt::format("The mean of {} overscan rows, above a bias of {:.6g} ADU, was subtracted from each column{}.",
                  above->area.ny, level, below != nullptr ? ", of each half of it" : ""));
}

}  // namespace astroid::detail
