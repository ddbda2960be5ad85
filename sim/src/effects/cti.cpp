#include "effects/cti.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/sim/charge_transfer.hpp"
#include "astroid/sim/scene.hpp"
#include "charge_chains.hpp"
#include "effects/need.hpp"

namespace astroid {

namespace {

/// First column that is read towards higher columns.
int middle_of(const CcdSettings& ccd) {
  return ccd.nodes.count > 1 ? (ccd.columns + 1) / 2 : ccd.columns;
}

TrapModel traps_of(const CcdSettings& ccd, const std::vector<double>& density, Seconds dwell) {
  TrapModel model;
  for (std::size_t k = 0; k < density.size(); ++k)
    model.species.push_back({density[k], ccd.cti.trap_cross_section[k], Seconds(ccd.cti.trap_release_time[k])});
  model.volume_power = ccd.cti.beta;
  model.temperature = ccd.cti.temperature;
  model.pixel_pitch = ccd.pixel_size;
  model.full_well = ccd.full_well;
  model.dwell = dwell;
  return model;
}

bool has_traps(const std::vector<double>& density) {
  return std::ranges::any_of(density, [](double d) { return d > 0.0; });
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

/// Packets ahead of one that it depends on, and whether charge is lost at all.
struct Reach {
  int rows = 0;
  int columns = 0;
};
Reach reach_of(const CcdSettings& ccd) {
  const int columns = ccd.columns + ccd.reference.prescan + ccd.reference.serial_overscan;
  const int rows = ccd.rows + ccd.reference.parallel_overscan;
  if (ccd.cti.model == CtiModel::kSimple)
    return {trail_length(ccd.cti.parallel, rows), trail_length(ccd.cti.serial, columns)};
  return {has_traps(ccd.cti.trap_density) ? rows : 0, has_traps(ccd.cti.register_density) ? columns : 0};
}

/// A region with the pixels ahead of it that it depends on.
Rectangle with_ahead(const Rectangle& r, const Rectangle& detector, const Reach& reach, int middle) {
  const int left = r.x0 < middle ? reach.columns : 0;
  const int right = r.x1() > middle ? reach.columns : 0;
  return intersect(detector, {r.x0 - left, r.y0 - reach.rows, r.nx + left + right, r.ny + reach.rows});
}

/// Exposed pixels that trail into the overscan that is delivered: of its rows, and of its columns.
struct Sources {
  std::vector<Rectangle> into_rows;
  std::vector<Rectangle> into_columns;
};
Sources sources_of(const Scene& scene) {
  const CcdSettings& ccd = scene.mission().ccd;
  const Rectangle detector = scene.detector();
  const Reach reach = reach_of(ccd);
  const int middle = middle_of(ccd);
  Sources sources;
  for (const Rectangle& reference : scene.layout()->reference_regions()) {
    if (reference.y0 >= detector.y1())
      sources.into_rows.push_back(
          with_ahead({reference.x0, detector.y1() - 1, reference.nx, 1}, detector, reach, middle));
    // With several nodes nothing is read behind the last column.
    else if (reference.x0 >= detector.x1() && middle == detector.x1())
      sources.into_columns.push_back(
          with_ahead({detector.x1() - 1, reference.y0, 1, reference.ny}, detector, reach, middle));
  }
  return sources;
}

bool is_whole(std::span<const Rectangle> exposed, const Rectangle& detector) {
  return exposed.size() == 1 && exposed.front() == detector;
}

/// Where each source is: behind all regions that were asked for, unless the only one is the whole detector. No effect
/// before this one asks for regions of its own.
void locate(const Sources& sources, ChargePixels& pixels) {
  const std::size_t count = sources.into_rows.size() + sources.into_columns.size();
  const bool whole = pixels.exposed == 1 && pixels.regions.front().area == pixels.detector;
  std::size_t next = whole ? 0 : pixels.exposed - count;
  const auto add = [&](std::vector<TrailSource>& to, const Rectangle& valid) {
    ASTROID_CHECK_EQ(intersect(pixels.regions[next].area, valid) == valid, true);
    to.push_back({next, valid});
    if (!whole) ++next;
  };
  for (const Rectangle& valid : sources.into_rows) add(pixels.into_rows, valid);
  for (const Rectangle& valid : sources.into_columns) add(pixels.into_columns, valid);
}

}  // namespace

EffectNeed Cti::is_needed(const SceneSummary& scene) const {
  const CcdSettings& ccd = scene.mission->ccd;
  const CtiSettings& cti = ccd.cti;
  switch (cti.model) {
    case CtiModel::kNone:
      return {false, "no charge is lost in transfers (CTI none)", 0.0, 0.0};
    case CtiModel::kSimple: {
      if (cti.parallel <= 0.0 && cti.serial <= 0.0)
        return {false, "no charge is lost in transfers (CTI/Parallel and Serial 0)", 0.0, 0.0};
      const double share = std::min(1.0, cti.parallel * ccd.rows + cti.serial * ccd.columns);
      return moved_charge_need(scene, share,
                               fmt::format("a loss of {:.3g} at each of {} transfers between rows and {:.3g} "
                                           "at each of {} between columns",
                                           cti.parallel, ccd.rows, cti.serial, ccd.columns));
    }
    case CtiModel::kTraps: {
      const double traps =
          2.0 / (1.0 + cti.beta) * (sum(cti.trap_density) * ccd.rows + sum(cti.register_density) * ccd.columns);
      if (traps <= 0.0) return {false, "no trap holds charge back (CTI/TrapDensity 0)", 0.0, 0.0};
      // Every trap on the way takes an electron, or gives one back, in every pixel; few electrons lose the most of
      // them.
      const double bias = traps * scene.aperture_pixels;
      const double least = scene.faintest_target_electrons + scene.background;
      const double variance_ratio = least > 0.0 ? 2.0 * std::min(1.0, bias / least) : 1.0;
      return {bias > scene.tightest_tolerance() || variance_ratio > kVarianceTolerance,
              fmt::format("up to {:.4g} traps lie on the way of a packet, {:.4g} in {:.3g} px; the tightest flux "
                          "tolerance is {:.3g} e-",
                          traps, bias, scene.aperture_pixels, scene.tightest_tolerance()),
              bias, variance_ratio};
    }
  }
  return {};
}

void Cti::support(const Scene& scene, std::vector<Rectangle>& regions) const {
  const Rectangle detector = scene.detector();
  if (is_whole(regions, detector)) return;
  const CcdSettings& ccd = scene.mission().ccd;
  const Reach reach = reach_of(ccd);
  for (Rectangle& r : regions) r = with_ahead(r, detector, reach, middle_of(ccd));
  const Sources sources = sources_of(scene);
  regions.insert(regions.end(), sources.into_rows.begin(), sources.into_rows.end());
  regions.insert(regions.end(), sources.into_columns.begin(), sources.into_columns.end());
}

void Cti::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  ChargePixels pixels;
  pixels.detector = context.scene.detector();
  pixels.exposed = context.camera.layout->exposed_regions().size();
  for (std::size_t a = 0; a < strip.areas.size(); ++a)
    pixels.regions.push_back({strip.areas[a], state.sampled.view(strip, a).data()});
  locate(sources_of(context.scene), pixels);
  const auto move = [&](const MoveChain& rows, const MoveChain& columns) {
    if (rows) state.lost_electrons += move_rows(pixels, rows);
    if (columns) state.lost_electrons += move_columns(pixels, middle_of(ccd), ccd.reference.prescan, columns);
  };
  if (ccd.cti.model == CtiModel::kSimple) {
    const auto losing = [](double loss) -> MoveChain {
      if (loss <= 0.0) return {};
      return [loss](const TransferChain& chain) { return transfer(chain, loss); };
    };
    move(losing(ccd.cti.parallel), losing(ccd.cti.serial));
  } else if (ccd.cti.model == CtiModel::kTraps) {
    const auto trapping = [&](const std::vector<double>& density, Seconds dwell) -> MoveChain {
      if (!has_traps(density)) return {};
      return [model = traps_of(ccd, density, dwell)](const TransferChain& chain) {
        return transfer_through_traps(chain, model);
      };
    };
    move(trapping(ccd.cti.trap_density, ccd.cti.row_time), trapping(ccd.cti.register_density, ccd.cti.column_time));
  }
}

}  // namespace astroid
