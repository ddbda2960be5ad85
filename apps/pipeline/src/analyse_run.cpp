#include "astroid/pipeline/analyse_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <system_error>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/core/fits_reader.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "folders.hpp"
#include "report_run.hpp"

namespace astroid {

namespace {

InputError not_a_run(const std::filesystem::path& folder, const std::string& what) {
  return InputError(Problem{.file = folder.string(),
                            .expected = "the folder of a finished `astroid assess` with Output/Lightcurves not none",
                            .message = what});
}

/// Exposure 0 of the first camera, if the run kept it: the report shows it.
Image<float, unit::Adu> first_frame(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "images" / "camera1_000000.fits";
  if (!std::filesystem::exists(file)) return {};
  const FitsReader fits(file);
  if (fits.units().front().axes.size() != 2) return {};  // windows
  return fits.read_image<float, unit::Adu>(1);
}

/// Statistics of the mean of the cameras before jitter correction, which is undone.
std::vector<SeriesSummary> measured_series(const std::filesystem::path& file, const GroundSegment& ground,
                                           std::int64_t exposures_per_bin) {
  const LightCurveReader reader(file.string());
  const LightCurveHeader& header = reader.contents().header;
  const std::size_t stars = reader.contents().stars.size();
  std::vector<std::vector<Attitude>> attitudes;
  for (int camera = 1; camera <= header.cameras; ++camera) attitudes.push_back(reader.attitudes(camera));
  SeriesStatistics statistics(stars, exposures_per_bin);
  std::vector<double> sum(static_cast<std::size_t>(header.exposures));
  std::vector<float> mean(sum.size());
  for (std::size_t star = 0; star < stars; ++star) {
    std::ranges::fill(sum, 0.0);
    for (int camera = 1; camera <= header.cameras; ++camera) {
      const LightCurve curve = reader.read(star, camera);
      const std::vector<Attitude>& attitude = attitudes[static_cast<std::size_t>(camera) - 1];
      const std::size_t group =
          header.group.empty() ? 0 : static_cast<std::size_t>(header.group[static_cast<std::size_t>(camera) - 1]);
      for (std::size_t k = 0; k < sum.size(); ++k) {
        const AttitudeCorrection& correction = correction_at(ground.corrections[group], static_cast<std::int64_t>(k));
        sum[k] += with_attitude(curve.flux[k] / curve.star.reference - 1.0, correction.responses()[star], attitude[k]);
      }
    }
    for (std::size_t k = 0; k < sum.size(); ++k) mean[k] = static_cast<float>(sum[k] / header.cameras);
    statistics.add(star, 0, mean);
  }
  return statistics.summaries();
}

/// What the stream would have left, read back from its products.
StreamResult read_stream(const std::filesystem::path& file, const Scene& scene, const GroundSegment& ground) {
  const FitsReader fits(file);
  const Mission& mission = scene.mission();
  const std::optional<int> table = fits.find_unit("STARS");
  const std::optional<int> curves = fits.find_unit(mission.telescope.simulated_cameras > 1 ? "COMBINED" : "CAMERA1");
  if (!table || !curves) throw not_a_run(file, "there are no light curves in the file");
  const std::vector<FitsUnit>& units = fits.units();
  const FitsUnit& image = units[static_cast<std::size_t>(*curves) - 1];
  const std::size_t targets = ground.estimators.front().size();
  const auto stars = static_cast<std::int64_t>(targets);
  if (image.axes.size() != 2 || image.axes[0] != mission.simulation.exposures || image.axes[1] != stars)
    throw not_a_run(
        file,
        fmt::format("the light curves hold {}, not {} stars of {} exposures: the configuration does not belong to them",
                    image.text(), stars, mission.simulation.exposures));
  const std::optional<std::size_t> reference = fits.find_column(*table, "REFERENCE");
  if (!reference) throw not_a_run(file, "the table of stars has no column REFERENCE");
  StreamResult result;
  result.reference = fits.read_numbers(*table, *reference);
  result.flags.resize(targets);
  for (const std::vector<StarEstimator>& estimators : ground.estimators)
    for (std::size_t t = 0; t < targets; ++t) result.flags[t] |= estimators[t].flags;
  if (const std::optional<int> flags = fits.find_unit("FLAGS")) {
    const auto star = fits.find_column(*flags, "STAR");
    const auto bits = fits.find_column(*flags, "FLAGS");
    if (star && bits) {
      const std::int64_t rows = units[static_cast<std::size_t>(*flags) - 1].rows;
      constexpr std::int64_t kRowsAtOnce = 65536;
      for (std::int64_t first = 0; first < rows; first += kRowsAtOnce) {
        const std::int64_t count = std::min(kRowsAtOnce, rows - first);
        const std::vector<std::int64_t> stars_flagged = fits.read_integers(*flags, *star, first, count);
        const std::vector<std::int64_t> flag = fits.read_integers(*flags, *bits, first, count);
        for (std::size_t i = 0; i < flag.size(); ++i) {
          const auto t = static_cast<std::size_t>(stars_flagged[i]);
          if (t < result.flags.size()) result.flags[t] |= static_cast<std::uint32_t>(flag[i]);
        }
      }
    }
  }
  SeriesStatistics statistics(targets,
                              std::max<std::int64_t>(2, static_cast<std::int64_t>(scene.summary().exposures_per_bin)),
                              mission.photometry.cotrending > 0);
  std::vector<float> deviation(static_cast<std::size_t>(mission.simulation.exposures));
  for (std::size_t t = 0; t < targets; ++t) {
    fits.read_pixels(*curves, static_cast<std::int64_t>(t) * mission.simulation.exposures, deviation);
    statistics.add(t, 0, deviation);
  }
  result.series = statistics.summaries();
  result.bin_means = all_bin_means(statistics, mission.simulation.exposures);
  if (!ground.corrections.front().empty())
    result.measured = measured_series(file, ground, statistics.exposures_per_bin());
  return result;
}

}  // namespace

AssessResult analyse_run(const std::filesystem::path& folder, const ConfigurationSurroundings& overrides,
                         const std::filesystem::path& output) {
  const std::filesystem::path configuration_file = folder / "config.xml";
  const std::filesystem::path light_curves = folder / "photometry" / "lightcurves.fits";
  if (!std::filesystem::is_directory(folder)) throw not_a_run(folder, "there is no such folder");
  if (!std::filesystem::exists(configuration_file)) throw not_a_run(folder, "there is no config.xml in it");
  if (!std::filesystem::exists(light_curves)) throw not_a_run(folder, "there is no photometry/lightcurves.fits in it");
  std::vector<Problem> problems;
  for (const std::string& override_text : overrides.overrides)
    if (!override_text.starts_with("Analysis/"))
      problems.push_back({.file = "--set",
                          .value = override_text,
                          .expected = "a parameter of Analysis",
                          .message = "would need the exposures again: run assess instead"});
  if (!problems.empty()) throw InputError(std::move(problems));

  const ResolvedConfiguration configuration = read_configuration(configuration_file, overrides);
  const PreparedRun run = prepare_run(configuration.mission);
  const GroundSegment ground = perfect_ground_segment(run);
  StreamResult stream = read_stream(light_curves, run.scene(), ground);
  stream.first_frame = first_frame(folder);
  create_folder(output);
  const ReportedRun reported = report_run(output, {.configuration = configuration,
                                                   .prepared = run,
                                                   .ground = ground,
                                                   .stream = stream,
                                                   .light_curves = light_curves});
  std::error_code ignored;
  if (std::filesystem::equivalent(folder, output, ignored)) refresh_run_record(folder);
  return {.folder = output, .report = reported.index, .verdict = reported.verdict, .timings = {}};
}

std::vector<std::filesystem::path> export_stars(const std::filesystem::path& folder, std::span<const std::string> ids,
                                                const std::filesystem::path& output) {
  const std::filesystem::path light_curves = folder / "photometry" / "lightcurves.fits";
  if (!std::filesystem::is_directory(folder)) throw not_a_run(folder, "there is no such folder");
  if (!std::filesystem::exists(light_curves)) throw not_a_run(folder, "there is no photometry/lightcurves.fits in it");
  // All are read before the first is written: a wrong id leaves nothing behind.
  std::vector<LightCurve> curves;
  const LightCurveReader reader(light_curves.string());
  LightCurveHeader header = reader.contents().header;
  header.history.clear();
  for (const std::string& id : ids) curves.push_back(reader.read(id, 0));
  create_folder(output);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string& id = ids[i];
    std::string name = id;
    std::ranges::replace_if(
        name, [](char c) { return c == '/' || c == ' '; }, '_');
    files.push_back(output / fmt::format("lightcurve_{}.fits", name));
    export_light_curve(files.back().string(), curves[i], header);
  }
  refresh_run_record(output.parent_path());
  return files;
}

}  // namespace astroid
