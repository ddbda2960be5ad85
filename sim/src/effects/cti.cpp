#include "effects/cti.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

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

bool holds(const std::vector<Rectangle>& regions, const Rectangle& wanted) {
  return std::ranges::any_of(regions, [&](const Rectangle& r) { return intersect(r, wanted) == wanted; });
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
      return moved_charge_need(scene, share, fmt::format("a loss of {:.3g} at each of {} transfers between rows and {:.3g} "
                                                         "at each of {} between columns",
                                                         cti.parallel, ccd.rows, cti.serial, ccd.columns));
    }
    case CtiModel::kTraps: {
      const double traps = 2.0 / (1.0 + cti.beta) *
                           (sum(cti.trap_density) * ccd.rows + sum(cti.register_density) * ccd.columns);
      if (traps <= 0.0) return {false, "no trap holds charge back (CTI/TrapDensity 0)", 0.0, 0.0};
      // Every trap on the way takes an electron, or gives one back, in every pixel; few electrons lose the most of them.
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
  const CcdSettings& ccd = scene.mission().ccd;
  const Rectangle detector = scene.detector();
  const Reach reach = reach_of(ccd);
  const int middle = middle_of(ccd);
  // What trails into overscan rows and columns comes from the last rows and columns.
  for (const Rectangle& reference : scene.layout()->reference_regions()) {
    const bool is_row = reference.y0 >= detector.y1();
    const bool is_column = reference.x0 >= detector.x1() && middle == detector.x1();
    if ((is_row && reach.rows == 0) || (is_column && reach.columns == 0) || (!is_row && !is_column)) continue;
    const Rectangle needed = is_row ? Rectangle{reference.x0, detector.y1() - 1, reference.nx, 1}
                                    : Rectangle{detector.x1() - 1, reference.y0, 1, reference.ny};
    if (!holds(regions, needed)) regions.push_back(needed);
  }
  for (Rectangle& r : regions) {
    const int left = r.x0 < middle ? reach.columns : 0;
    const int right = r.x1() > middle ? reach.columns : 0;
    r = intersect(detector, {r.x0 - left, r.y0 - reach.rows, r.nx + left + right, r.ny + reach.rows});
  }
}

void Cti::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const Rectangle detector = context.scene.detector();
  const std::size_t exposed = context.camera.layout->exposed_regions().size();
  std::vector<ChargeRegion> regions;
  for (std::size_t a = 0; a < strip.areas.size(); ++a)
    regions.push_back({strip.areas[a], state.sampled.view(strip, a).data()});
  const auto move = [&](const MoveChain& rows, const MoveChain& columns) {
    if (rows) state.lost_electrons += move_rows(regions, exposed, detector, rows);
    if (columns)
      state.lost_electrons +=
          move_columns(regions, exposed, detector, middle_of(ccd), ccd.reference.prescan, columns);
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
