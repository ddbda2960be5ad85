#include "image_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "astroid/core/calendar.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/fits_writer.hpp"
#include "astroid/core/units.hpp"
#include "folders.hpp"

namespace astroid {

namespace {

constexpr int kSixteenBits = 16;

std::string file_name(int camera, std::int64_t exposure) {
  return fmt::format("camera{}_{:06}", camera + 1, exposure);
}

/// Cards that every image of an exposure carries.
std::vector<FitsCard> exposure_cards(const Scene& scene, int camera, std::int64_t exposure) {
  const Mission& mission = scene.mission();
  const double start =
      mission.simulation.start_mjd +
      (mission.simulation.stagger.value() + static_cast<double>(exposure) * mission.simulation.cycle.value()) /
          kSecondsPerDay;
  constexpr int kMilliseconds = 3;
  return {{"TELESCOP", "ASTROID", "simulated"},
          {"SIMULATE", true, "not flight data"},
          {"CAMERA", camera + 1, "camera number"},
          {"EXPOSURE", exposure, "exposure number, from 0"},
          {"TIMESYS", "TDB", "time scale"},
          {"DATE-OBS", iso8601_from_mjd(start, kMilliseconds), "start of the exposure"},
          {"MJD-OBS", start, "[d] the same"},
          {"EXPTIME", mission.simulation.exposure_time.value(), "[s] exposure time"},
          {"SEED", static_cast<std::int64_t>(mission.simulation.seed), "of the random numbers"}};
}

/// Cards of a frame in ADU.
std::vector<FitsCard> image_cards(const Scene& scene, const FrameHeader& header) {
  std::vector<FitsCard> cards = exposure_cards(scene, header.camera, header.exposure);
  cards.insert(cards.end(), {{"BUNIT", "adu", "unit of the pixels"},
                             {"GAIN", header.gain.value(), "[e-/adu] gain"},
                             {"RDNOISE", header.readout_noise.value(), "[e-] readout noise, rms"},
                             {"BIAS", header.bias.value(), "[adu] bias"},
                             {"SATURATE", header.saturation.value(), "[adu] saturation level"}});
  return cards;
}

FitsNumber count_format(const Scene& scene) {
  return delivered_bits(scene.mission()) <= kSixteenBits ? FitsNumber::kUnsigned16 : FitsNumber::kInt32;
}

/// Where a sub-image lies: its WCS and the detector pixel of its first one.
std::vector<FitsCard> place_cards(const Scene& scene, const Rectangle& area) {
  std::vector<FitsCard> cards = scene.projection()->fits_cards(area.x0, area.y0);
  cards.emplace_back("LTV1", -area.x0, "image column = detector column + LTV1");
  cards.emplace_back("LTV2", -area.y0, "image row = detector row + LTV2");
  return cards;
}

bool is_cube(const PixelLayout& layout) {
  return layout.exposed_regions().size() > 1;
}

/// The largest window; smaller ones, cut by the edge, are padded to its size.
std::pair<int, int> cube_size(const PixelLayout& layout) {
  int nx = 0;
  int ny = 0;
  for (const Rectangle& region : layout.exposed_regions()) {
    nx = std::max(nx, region.nx);
    ny = std::max(ny, region.ny);
  }
  return {nx, ny};
}

/// The regions of a plane as a cube of windows, with a table of where they lie.
template <class Pixel, class Unit>
void write_windows(FitsWriter& fits, const Plane<Pixel, Unit>& plane, FitsNumber number, const Scene& scene,
                   std::span<const FitsCard> cards, std::span<const std::string> history) {
  const PixelLayout& layout = plane.layout();
  const auto [nx, ny] = cube_size(layout);
  const auto count = static_cast<std::int64_t>(layout.exposed_regions().size());
  fits.begin_image(number, {nx, ny, count});
  fits.cards(cards);
  for (const std::string& line : history) fits.history(line);
  std::vector<Pixel> window;
  for (std::size_t r = 0; r < layout.exposed_regions().size(); ++r) {
    const Rectangle& area = layout.regions()[r];
    window.assign(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), Pixel{});
    for (int y = area.y0; y < area.y1(); ++y)
      std::ranges::copy(plane.view(r).row(y), window.begin() + static_cast<std::ptrdiff_t>(y - area.y0) * nx);
    fits.write_pixels(static_cast<std::int64_t>(r) * nx * ny, std::span<const Pixel>(window));
  }
  fits.begin_table({{.name = "ID", .text_width = 32},
                    {.name = "X0", .number = FitsNumber::kInt32, .unit = "px"},
                    {.name = "Y0", .number = FitsNumber::kInt32, .unit = "px"},
                    {.name = "NX", .number = FitsNumber::kInt32, .unit = "px"},
                    {.name = "NY", .number = FitsNumber::kInt32, .unit = "px"}},
                   "WINDOWS", count);
  std::vector<std::string> ids;
  std::vector<std::int32_t> x0;
  std::vector<std::int32_t> y0;
  std::vector<std::int32_t> widths;
  std::vector<std::int32_t> heights;
  constexpr std::size_t kLongestId = 32;
  for (std::size_t r = 0; r < layout.exposed_regions().size(); ++r) {
    ids.push_back(scene.stars()[scene.targets()[r]].id.substr(0, kLongestId));
    x0.push_back(layout.regions()[r].x0);
    y0.push_back(layout.regions()[r].y0);
    widths.push_back(layout.regions()[r].nx);
    heights.push_back(layout.regions()[r].ny);
  }
  fits.write_column(0, 0, std::span<const std::string>(ids));
  fits.write_column(1, 0, std::span<const std::int32_t>(x0));
  fits.write_column(2, 0, std::span<const std::int32_t>(y0));
  fits.write_column(3, 0, std::span<const std::int32_t>(widths));
  fits.write_column(4, 0, std::span<const std::int32_t>(heights));
}

template <class Pixel, class Unit>
void write_plane(FitsWriter& fits, const Plane<Pixel, Unit>& plane, FitsNumber number, const Scene& scene,
                 std::span<const FitsCard> cards, std::span<const std::string> history) {
  if (is_cube(plane.layout())) {
    write_windows(fits, plane, number, scene, cards, history);
    return;
  }
  const Rectangle& area = plane.layout().regions()[0];
  fits.begin_image(number, {area.nx, area.ny});
  fits.cards(place_cards(scene, area));
  fits.cards(cards);
  for (const std::string& line : history) fits.history(line);
  fits.write_plane(plane.view(0));
}

/// Extensions PRESCAN, OVERSCAN and SERIAL-OVERSCAN: one for each region of reference pixels, numbered by EXTVER.
void write_reference_pixels(FitsWriter& fits, const Frame& frame, FitsNumber number, const Rectangle& detector) {
  const PixelLayout& layout = frame.pixels.layout();
  std::map<std::string, int> versions;
  for (std::size_t r = layout.exposed_regions().size(); r < layout.regions().size(); ++r) {
    const Rectangle& area = layout.regions()[r];
    const bool is_prescan = area.x1() <= detector.x0;
    const bool is_overscan = area.y0 >= detector.y1() || area.y1() <= detector.y0;
    const std::string name = is_prescan ? "PRESCAN" : is_overscan ? "OVERSCAN" : "SERIAL-OVERSCAN";
    fits.begin_image(number, {area.nx, area.ny}, name);
    fits.card({"EXTVER", ++versions[name], "number among those of this name"});
    fits.card({"BUNIT", "adu", "unit of the pixels"});
    fits.card({"LTV1", -area.x0, "image column = detector column + LTV1"});
    fits.card({"LTV2", -area.y0, "image row = detector row + LTV2"});
    fits.write_plane(frame.pixels.view(r));
  }
}

/// The map that a step has just written, in its own unit.
void write_step(FitsWriter& fits, const EffectSpec& effect, const ExposureState& state, const Scene& scene,
                std::span<const std::string> history) {
  std::vector<FitsCard> cards = exposure_cards(scene, state.camera, state.exposure);
  cards.emplace_back("STEP", std::string(effect.name), "effect after which this map was written");
  if ((effect.writes & plane_bit::kDigital) != 0) {
    cards.emplace_back("BUNIT", "adu", "digitised");
    write_plane(fits, state.frame.pixels, FitsNumber::kFloat32, scene, cards, history);
  } else if ((effect.writes & plane_bit::kAnalog) != 0) {
    cards.emplace_back("BUNIT", "adu", "before digitising");
    write_plane(fits, state.analog.whole(), FitsNumber::kFloat64, scene, cards, history);
  } else if ((effect.writes & plane_bit::kSampled) != 0) {
    cards.emplace_back("BUNIT", "electron", "drawn electrons");
    write_plane(fits, state.sampled.whole(), FitsNumber::kFloat64, scene, cards, history);
  } else {
    cards.emplace_back("BUNIT", "electron", "expected electrons");
    write_plane(fits, state.expected.whole(), FitsNumber::kFloat64, scene, cards, history);
  }
}

}  // namespace

std::vector<std::string> history_of(const Plan& plan, const Scene& scene) {
  std::vector<std::string> lines;
  std::istringstream text(to_text(plan, scene));
  for (std::string line; std::getline(text, line);) {
    // Times are of the machine, not of the product.
    const bool has_time = line.find(" ms per exposure") != std::string::npos;
    if (!line.empty() && !has_time) lines.push_back(line);
  }
  return lines;
}

Image<float, unit::Adu> largest_region(const Frame& frame) {
  const PixelLayout& layout = frame.pixels.layout();
  std::size_t largest = 0;
  for (std::size_t r = 1; r < layout.exposed_regions().size(); ++r)
    if (layout.regions()[r].size() > layout.regions()[largest].size()) largest = r;
  Image<float, unit::Adu> image(layout.regions()[largest]);
  const Rectangle& area = image.area();
  for (int y = area.y0; y < area.y1(); ++y) std::ranges::copy(frame.pixels.view(largest).row(y), image.row(y).begin());
  return image;
}

ImageFiles::ImageFiles(const Scene& scene, const Plan& plan, std::filesystem::path folder)
    : scene_(scene), history_(history_of(plan, scene)), folder_(std::move(folder)) {
  const PixelLayout& layout = *scene.layout();
  if (folder_.empty() || is_cube(layout) || !layout.reference_regions().empty()) return;
  const Rectangle& area = layout.regions()[0];
  std::vector<FitsCard> cards = place_cards(scene, area);
  for (FitsCard& card : image_cards(scene, {})) cards.push_back(std::move(card));
  series_.emplace(count_format(scene), area.nx, area.ny, cards, history_);
}

bool ImageFiles::writes(int /*camera*/, std::int64_t exposure) const {
  if (folder_.empty()) return false;
  const OutputSettings& output = scene_.mission().output;
  switch (output.images) {
    case ImageOutput::kNone:
      return false;
    case ImageOutput::kFirst:
      return exposure == 0;
    case ImageOutput::kEvery:
      return exposure % output.images_every == 0;
    case ImageOutput::kAll:
      return true;
  }
  return false;
}

bool ImageFiles::dumps(int /*camera*/, std::int64_t exposure) const {
  const std::vector<std::int64_t>& asked = scene_.mission().output.dump_steps;
  return !folder_.empty() && std::ranges::find(asked, exposure) != asked.end();
}

void ImageFiles::write(const Frame& frame) const {
  const std::filesystem::path folder = folder_ / "images";
  create_folder(folder);
  const std::filesystem::path file = folder / (file_name(frame.header.camera, frame.header.exposure) + ".fits");
  const std::vector<FitsCard> cards = image_cards(scene_, frame.header);
  if (series_) {
    const std::span<const float> counts(frame.pixels.view(0).data(), frame.pixels.layout().regions()[0].size());
    series_->write(file, counts, cards, Durability::kWithFolder);
    return;
  }
  FitsWriter fits(file);
  write_plane(fits, frame.pixels, count_format(scene_), scene_, cards, history_);
  write_reference_pixels(fits, frame, count_format(scene_), scene_.detector());
  fits.commit(Durability::kWithFolder);
}

StepObserver ImageFiles::step_writer(int camera, std::int64_t exposure) const {
  const std::filesystem::path folder = folder_ / "steps";
  create_folder(folder);
  return [this, folder, stem = file_name(camera, exposure), number = 0](const EffectSpec& effect,
                                                                        const ExposureState& state) mutable {
    if (effect.level == EffectLevel::kPointing || effect.writes == plane_bit::kFlags) return;  // no map changes
    // Of several reads the steps between are there once for each.
    FitsWriter fits(folder / fmt::format("{}_{:02}_{}.fits", stem, ++number, effect.name));
    write_step(fits, effect, state, scene_, history_);
    fits.commit(Durability::kWithFolder);
  };
}

}  // namespace astroid
