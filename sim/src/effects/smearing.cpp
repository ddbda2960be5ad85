#include "effects/smearing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "astroid/core/column_light.hpp"
#include "astroid/sim/scene.hpp"
#include "astroid/sim/smearing.hpp"
#include "effects/need.hpp"

namespace astroid {

namespace {

EffectNeed smearing_need(const SceneSummary& scene, SmearingModel model) {
  const Mission& mission = *scene.mission;
  const SmearingSettings& smearing = mission.ccd.smearing;
  if (smearing.model != model)
    return {false,
            smearing.model == SmearingModel::kNone ? "the detector has a shutter (smearing none)"
                                                   : "the detector is read in another way",
            0.0, 0.0};
  const ReadoutNodes nodes({0, 0, mission.ccd.columns, mission.ccd.rows}, mission.ccd.nodes.count);
  // The upper half is the smaller one where the rows are odd.
  const int rows = nodes.splits_columns() ? mission.ccd.rows - nodes.middle_y() : mission.ccd.rows;
  const double share = clocking_share(smearing.time.value(), mission.simulation.exposure_time.value(), rows);
  const double level = share * scene.brightest_column;
  EffectNeed need = background_need(scene, level, "what the brightest column smears into each of its pixels");
  need.why = fmt::format("{} (every row collects {:.3g} of a column's light)", need.why, share);
  return need;
}

void prepare_columns(CameraState& camera, const Scene& scene) {
  int first = scene.detector().x1();
  int last = scene.detector().x0;
  for (const Rectangle& area : camera.layout->regions()) {
    first = std::min(first, std::max(area.x0, scene.detector().x0));
    last = std::max(last, std::min(area.x1(), scene.detector().x1()));
  }
  auto halves = std::make_shared<std::vector<SmearedColumns>>();
  for (int half = 0; half < readout_nodes(scene).halves(); ++half)
    halves->emplace_back(scene, first, std::max(0, last - first), half);
  camera.smearing = std::move(halves);
}

void add_to_rows(ExposureState& state, const EffectContext& context, const Strip& strip) {
  const Rectangle detector = context.scene.detector();
  const ReadoutNodes nodes = readout_nodes(context.scene);
  std::vector<double> smeared;
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const Rectangle& area = strip.areas[a];
    if (area.x0 < detector.x0 || area.x1() > detector.x1()) continue;  // prescan and serial overscan
    smeared.resize(static_cast<std::size_t>(area.nx));
    const auto view = state.expected.view(strip, a);
    int half = -1;
    for (int y = area.y0; y < area.y1(); ++y) {
      if (nodes.half_of(y) != half) {
        half = nodes.half_of(y);
        const SmearedColumns& columns = (*context.camera.smearing)[static_cast<std::size_t>(half)];
        columns.at(state.attitude.mean, state.conditions.throughput, area.x0, smeared);
      }
      double* row = view.row(y).data();
      for (std::size_t i = 0; i < smeared.size(); ++i) row[i] += smeared[i];
    }
  }
}

}  // namespace

EffectNeed OpenShutterSmearing::is_needed(const SceneSummary& scene) const {
  return smearing_need(scene, SmearingModel::kOpenShutter);
}

void OpenShutterSmearing::prepare(CameraState& camera, const PrepareContext& context) const {
  prepare_columns(camera, context.scene);
}

void OpenShutterSmearing::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_to_rows(state, context, strip);
}

EffectNeed FrameTransferSmearing::is_needed(const SceneSummary& scene) const {
  return smearing_need(scene, SmearingModel::kFrameTransfer);
}

void FrameTransferSmearing::prepare(CameraState& camera, const PrepareContext& context) const {
  prepare_columns(camera, context.scene);
  camera.unsmeared = missing_from_behind(context.scene, camera.layout);
}

void FrameTransferSmearing::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  add_to_rows(state, context, strip);
  if (context.camera.unsmeared.empty()) return;
  const std::span<double> expected = state.expected.pixels(strip);
  const std::span<const float> missing = context.camera.unsmeared.pixels().subspan(strip.begin, strip.size());
  // Never below zero: motion moves what is added, not what is missing.
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[i] = std::max(0.0, expected[i] - state.conditions.throughput * static_cast<double>(missing[i]));
}

}  // namespace astroid
