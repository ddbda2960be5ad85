#include "effects/sub_pixel_stars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"
#include "effects/rolling_shutter.hpp"
#include "effects/star_light.hpp"
#include "star_lists.hpp"

namespace astroid {

namespace {

/// Sums the light of the cells of each pixel of a tile, weighted with their sensitivity.
/// @param cells  shape (area.ny n, area.nx n)  @param light  [out] shape (area.ny, area.nx)
void sum_cells(const Rectangle& area, int n, const std::optional<IntraPixelState>& response,
               std::span<const double> cells, std::span<double> light) {
  const auto count = static_cast<std::size_t>(n);
  const auto nx = static_cast<std::size_t>(area.nx);
  const bool differs = response && response->flat > 0.0;
  std::vector<float> normals(differs ? light.size() : 0);
  std::vector<double> weights(differs ? light.size() : 0);  // sums of the cells' sensitivities
  std::ranges::fill(light, 0.0);
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t column = 0; column < count; ++column) {
      const double common = response ? response->common.at(static_cast<int>(column), static_cast<int>(row)) : 1.0;
      if (differs)
        pixel_normals(response->stream, {.areas = {&area, 1}, .draw = static_cast<std::uint16_t>(row * count + column)},
                      normals);
      for (std::size_t y = 0; y < static_cast<std::size_t>(area.ny); ++y) {
        const double* from = &cells[((y * count + row) * nx) * count + column];
        for (std::size_t x = 0; x < nx; ++x) {
          const std::size_t pixel = y * nx + x;
          double weight = common;
          if (differs) {
            weight *= std::max(0.0, 1.0 + response->flat * static_cast<double>(normals[pixel]));
            weights[pixel] += weight;
          }
          light[pixel] += weight * from[x * count];
        }
      }
    }
  }
  // What a pixel is as a whole is not the cells' business.
  if (differs)
    for (std::size_t i = 0; i < light.size(); ++i) light[i] *= static_cast<double>(count * count) / weights[i];
}

/// @param rows  of the tile that are added.
void add_to_areas(const Rectangle& tile, const Rectangle& rows, std::span<const double> light, ExposureState& state,
                  const Strip& strip) {
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle common = intersect(strip.areas[a], rows);
    if (common.empty()) continue;
    const ImageView<double, unit::ExpectedElectrons> view = state.expected.view(strip, a);
    for (int y = common.y0; y < common.y1(); ++y) {
      const double* from = &light[static_cast<std::size_t>((y - tile.y0) * tile.nx + common.x0 - tile.x0)];
      double* to = &view.at(common.x0, y);
      for (int x = 0; x < common.nx; ++x) to[x] += from[x];
    }
  }
}

}  // namespace

EffectNeed SubPixelStars::is_needed(const SceneSummary& scene) const {
  const RendererChoice choice = choose_renderer(*scene.mission);
  if (choice.renderer != Renderer::kSubPixel)
    return {false, fmt::format("stars are made by the renderer {}", to_string(choice.renderer)), 0.0, 0.0};
  if (scene.stars == 0) return {false, "no star of the catalogue falls on the detector", 0.0, 0.0};
  return {true,
          fmt::format("{}: {} stars on a map of sub-pixels, {} of them targets; the brightest ({}) gives {:.4g} e- per "
                      "exposure",
                      choice.why, scene.stars, scene.targets, scene.brightest_id, scene.brightest_electrons),
          scene.brightest_electrons, 1.0};
}

void SubPixelStars::support(const Scene& /*scene*/, std::vector<Rectangle>& /*regions*/) const {}

void SubPixelStars::prepare(CameraState& camera, const PrepareContext& context) const {
  const SubPixelRenderer* renderer = context.scene.sub_pixel_renderer();
  if (renderer == nullptr) return;
  std::vector<Rectangle> tiles;
  for (const Rectangle& tile : renderer->tiles())
    if (std::ranges::any_of(camera.layout->exposed_regions(),
                            [&](const Rectangle& region) { return !intersect(region, tile).empty(); }))
      tiles.push_back(tile);
  PlanKnobs knobs;
  knobs.stamps = {{.min_electrons = 0.0, .half_width = renderer->reach(), .stars = 0}};
  auto lists = star_lists(context.scene, knobs, tiles, farthest_attitude(context),
                          context.knobs.variables ? StarChoice::kConstant : StarChoice::kAll);
  for (std::size_t i = 0; i < tiles.size(); ++i) camera.tiles.push_back({tiles[i], std::move(lists[i])});
}

void SubPixelStars::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const SubPixelRenderer* renderer = context.scene.sub_pixel_renderer();
  if (renderer == nullptr) return;
  const int n = renderer->cells();
  std::vector<StarLight> stars;
  std::vector<double> light;
  for (const SubPixelTile& tile : context.camera.tiles) {
    // With a rolling shutter a tile is rendered for each band of rows in it, and the rows of the band are taken.
    const int band = state.bands.attitude.empty() ? tile.area.y1() : state.bands.rows;
    for (int y = tile.area.y0; y < tile.area.y1();) {
      const int end = std::min(tile.area.y1(), (y / band + 1) * band);
      look_at_row(state, y);
      stars.clear();
      double brightest = 0.0;
      for (const RenderedStar& star : tile.stars) {
        brightest = std::max(brightest, star.electrons * state.conditions.throughput);
        for_each_light(star, state, context.knobs.jitter, [&](const StarLight& one) { stars.push_back(one); });
      }
      light.resize(tile.area.size());
      const auto cells = tile.area.size() * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
      if (n == 1) {
        renderer->render_cells(tile.area, stars, state.sub_pixel, light);
      } else {
        state.scratch.resize(std::max(state.scratch.size(), cells));
        renderer->render_cells(tile.area, stars, state.sub_pixel, std::span(state.scratch).first(cells));
        sum_cells(tile.area, n, context.camera.intra_pixel, std::span(state.scratch).first(cells), light);
      }
      state.ringing.add(silence(light, renderer->predicted_error() * brightest));
      add_to_areas(tile.area, {tile.area.x0, y, tile.area.nx, end - y}, light, state, strip);
      y = end;
    }
  }
}

}  // namespace astroid
