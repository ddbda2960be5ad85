#include "astroid/pipeline/focal_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/camera_groups.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/product_folder.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "astroid/reports/focal_plane.hpp"
#include "report_run.hpp"

namespace astroid {

namespace {

constexpr double kSecondsPerHour = 3600.0;

/// Squares with their centres in the middle of equal parts of the detector, moved to lie in it.
std::vector<Rectangle> sub_fields(const Mission& mission, const FocalPlaneOptions& maps) {
  const int nx = std::min(maps.side, mission.ccd.columns);
  const int ny = std::min(maps.side, mission.ccd.rows);
  std::vector<Rectangle> fields;
  for (int j = 0; j < maps.down; ++j)
    for (int i = 0; i < maps.across; ++i) {
      const auto first = [](int part, int parts, int whole, int size) {
        const double centre = (part + 0.5) * whole / parts;
        return std::clamp(static_cast<int>(std::lround(centre - 0.5 * size)), 0, whole - size);
      };
      fields.push_back(
          {first(i, maps.across, mission.ccd.columns, nx), first(j, maps.down, mission.ccd.rows, ny), nx, ny});
    }
  return fields;
}

double median_magnitude(const Scene& scene) {
  std::vector<double> magnitudes;
  for (const std::size_t star : full_frame_targets(scene)) magnitudes.push_back(scene.stars()[star].magnitude.value());
  if (magnitudes.empty()) return 0.0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle;
}

/// The mission of one group of cameras alone. @throws InputError for a group that it does not have
Mission of_one_group(const Mission& mission, int group) {
  const int count = group_count(mission.telescope);
  if (group < 1 || group > count)
    throw InputError(Problem{.parameter = "--group",
                             .value = fmt::format("{}", group),
                             .expected = fmt::format("1 to {}", count),
                             .message = "the mission has no such group of cameras"});
  Mission alone = group_mission(mission, group - 1);
  if (mission.telescope.groups.cameras.empty()) return alone;
  alone.telescope.cameras = mission.telescope.groups.cameras[static_cast<std::size_t>(group) - 1];
  alone.telescope.simulated_cameras =
      mission.telescope.simulated_cameras * alone.telescope.cameras / mission.telescope.cameras;
  return alone;
}

/// Simulates one sub-field and measures its targets; nothing is written.
std::vector<TargetMetrics> measure(const PreparedRun& run, const ResolvedConfiguration& configuration,
                                   const StreamOptions& stream_options) {
  if (run.scene().targets().empty()) return {};
  const GroundSegment ground = perfect_ground_segment(run);
  const StreamResult stream = stream_exposures(stream_groups(run, ground), stream_options);
  return target_metrics({.configuration = configuration,
                         .prepared = run,
                         .ground = ground,
                         .stream = stream,
                         .light_curves = {},
                         .threads = stream_options.threads},
                        run_setup(run.scene().mission()));
}

}  // namespace

FocalPlaneResult map_focal_plane(const ResolvedConfiguration& configuration, const RunOptions& options,
                                 const FocalPlaneOptions& maps) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  // Groups see different stars on a part of the detector: a map is of one of them, with its own cameras.
  const Mission camera = of_one_group(configuration.mission, maps.group);
  ProductFolder folder(options.folder, options.existing);
  const std::filesystem::path working = partial_path(folder.path());
  FocalPlaneResult result;
  const std::vector<Rectangle> fields = sub_fields(camera, maps);
  const auto all = static_cast<std::int64_t>(fields.size());
  for (std::int64_t i = 0; i < all; ++i) {
    const Rectangle& area = fields[static_cast<std::size_t>(i)];
    Mission mission = camera;
    mission.ccd.has_sub_field = true;
    mission.ccd.sub_x0 = area.x0;
    mission.ccd.sub_y0 = area.y0;
    mission.ccd.sub_columns = area.nx;
    mission.ccd.sub_rows = area.ny;
    mission.ccd.window = 0;
    const PreparedRun run = prepare_run(mission);
    if (i == 0) {
      result.reference_magnitude = maps.magnitude.value_or(median_magnitude(run.scene()));
      write_text_file(working / "config.xml", to_xml(configuration));
    }
    const std::vector<TargetMetrics> targets =
        measure(run, configuration,
                {.threads = options.threads, .folder = {}, .progress = [&](std::int64_t done, std::int64_t of) {
                   if (options.progress) options.progress(i * of + done, all * of);
                 }});
    result.sub_fields.push_back(sub_field_metrics(area, targets, result.reference_magnitude, run_setup(camera)));
    if (result.sub_fields.back().clean == 0)
      result.warnings.push_back(
          fmt::format("the sub-field at column {}, row {} has no clean target near magnitude {:.2f}", area.x0, area.y0,
                      result.reference_magnitude));
  }
  if (std::ranges::all_of(result.sub_fields, [](const SubFieldMetrics& s) { return s.clean == 0; }))
    throw InputError(Problem{.file = configuration.mission.field.catalogue,
                             .parameter = "--magnitude",
                             .value = fmt::format("{:.2f}", result.reference_magnitude),
                             .expected = "a magnitude near which sub-fields have targets",
                             .message = "no sub-field has a clean target near it"});
  const std::vector<std::string> problems =
      write_focal_plane(working, {.detector = {0, 0, configuration.mission.ccd.columns, configuration.mission.ccd.rows},
                                  .sub_fields = result.sub_fields,
                                  .reference_magnitude = result.reference_magnitude,
                                  .passband = configuration.mission.telescope.zero_point_passband,
                                  .bin_hours = configuration.mission.analysis.bin.value() / kSecondsPerHour,
                                  .cameras = camera.telescope.cameras,
                                  .threads = options.threads});
  result.warnings.insert(result.warnings.end(), problems.begin(), problems.end());
  write_run_record(folder, {.command_line = options.command_line,
                            .threads = options.threads,
                            .wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count(),
                            .warnings = result.warnings});
  folder.commit();
  return result;
}

}  // namespace astroid
