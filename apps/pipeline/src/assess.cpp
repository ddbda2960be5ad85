#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <future>
#include <string>
#include <utility>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/product_folder.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/run.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "folders.hpp"
#include "report_run.hpp"

namespace astroid {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kLightCurves = "photometry/lightcurves.fits";

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What every run leaves: its configuration, plan and truth.
void write_inputs(const std::filesystem::path& folder, const ResolvedConfiguration& configuration,
                  const PreparedRun& run) {
  write_text_file(folder / "config.xml", to_xml(configuration));
  write_text_file(folder / "plan.txt", plan_text(run));
  write_text_file(folder / "plan.json", plan_json(run));
  create_folder(folder / "truth");
  for (std::size_t g = 0; g < run.groups.size(); ++g) {
    const std::string suffix = g == 0 ? "" : fmt::format("_group{}", g + 1);
    write_truth(folder / "truth" / ("stars" + suffix + ".csv"), *run.groups[g].scene);
    write_variable_truth(folder / "truth", *run.groups[g].scene, suffix);
  }
}

}  // namespace

AssessResult assess(const ResolvedConfiguration& configuration, const RunOptions& options) {
  const Clock::time_point begin = Clock::now();
  ProductFolder folder(options.folder, options.existing);
  const std::filesystem::path working = partial_path(folder.path());
  const PreparedRun run = prepare_run(configuration.mission);
  if (run.groups.front().targets.empty())
    throw InputError(
        Problem{.file = configuration.mission.field.catalogue,
                .parameter = "Satellite/Pointing",
                .expected = "a field with stars brighter than Photometry/TargetLimit on the computed pixels of every "
                            "group of cameras",
                .message = "there is no target to assess"});
  const GroundSegment ground = perfect_ground_segment(run);
  write_inputs(working, configuration, run);
  const StreamResult stream = stream_exposures(
      stream_groups(run, ground), {.threads = options.threads, .folder = working, .progress = options.progress});
  const Clock::time_point analysis_begin = Clock::now();
  // The largest product by far is complete: its checksum is computed while the report is made.
  const std::filesystem::path light_curves = working / kLightCurves;
  std::future<std::string> checksum;
  if (std::filesystem::exists(light_curves))
    checksum =
        std::async(options.threads == 1 ? std::launch::deferred : std::launch::async, sha256_of_file, light_curves);
  const ReportedRun reported = report_run(working, {.configuration = configuration,
                                                    .prepared = run,
                                                    .ground = ground,
                                                    .stream = stream,
                                                    .light_curves = light_curves,
                                                    .threads = options.threads});
  KnownChecksums checksums;
  if (checksum.valid()) checksums[kLightCurves] = checksum.get();
  write_run_record(folder, {.command_line = options.command_line,
                            .threads = options.threads,
                            .run = &run,
                            .stream = &stream,
                            .analyse_seconds = seconds_since(analysis_begin),
                            .wall_seconds = seconds_since(begin),
                            .warnings = reported.warnings,
                            .checksums = checksums});
  const std::filesystem::path index = reported.index.lexically_relative(working);
  folder.commit();
  return {.folder = options.folder,
          .report = options.folder / index,
          .verdict = reported.verdict,
          .timings = stream.timings};
}

StreamResult simulate(const ResolvedConfiguration& configuration, const RunOptions& options) {
  const Clock::time_point begin = Clock::now();
  ProductFolder folder(options.folder, options.existing);
  const std::filesystem::path working = partial_path(folder.path());
  const PreparedRun run = prepare_run(configuration.mission);
  write_inputs(working, configuration, run);
  StreamResult stream = stream_exposures(stream_groups(run, {}),
                                         {.threads = options.threads, .folder = working, .progress = options.progress});
  write_run_record(folder, {.command_line = options.command_line,
                            .threads = options.threads,
                            .run = &run,
                            .stream = &stream,
                            .wall_seconds = seconds_since(begin),
                            .warnings = run.notes});
  folder.commit();
  return stream;
}

}  // namespace astroid
