#include "report_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "astroid/analysis/contamination.hpp"
#include "astroid/analysis/group_mean.hpp"
#include "astroid/analysis/target_metrics.hpp"
#include "astroid/analysis/verdict.hpp"
#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/pipeline/motion.hpp"
#include "astroid/pipeline/run_record.hpp"
#include "astroid/reports/report.hpp"
#include "cotrend_run.hpp"
#include "folders.hpp"

namespace astroid {

namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr std::size_t kListedNeighbours = 3;
constexpr double kNeighbourReach = 12.0;  ///< px; farther neighbours put no light worth a line into an aperture
constexpr std::size_t kShownLightCurves = 6;

/// photometry/sources.csv: the mean flux of every target over the run.
void write_mean_sources(const std::filesystem::path& path, const MeasuredRun& run,
                        std::span<const TargetMetrics> targets) {
  const Scene& scene = run.prepared.scene();
  const double background = expected_pixel_noise(scene.mission()).background;
  std::vector<SourceMeasurement> sources;
  sources.reserve(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TargetMetrics& target = targets[t];
    const SceneStar& star = scene.stars()[run.prepared.groups.front().targets[t]];
    const double ratio = target.nsr_exposure_measured.value / target.nsr_exposure;
    sources.push_back({.id = target.id,
                       .x = target.x,
                       .y = target.y,
                       .ra = star.sky.ra,
                       .dec = star.sky.dec,
                       .flux = target.flux_measured,
                       .flux_err = target.flux_err,
                       .mag = target.mag_measured,
                       .mag_err = target.mag_err,
                       .background = background,
                       .snr = target.flux_measured / target.flux_err,
                       .chi2 = ratio * ratio,
                       .flags = target.flags});
  }
  write_sources(path, sources);
}

std::vector<ContaminationRow> contamination_rows(const MeasuredRun& run, std::span<const TargetMetrics> targets) {
  // Of several groups of cameras those that the first one sees.
  const auto neighbours =
      strongest_contaminants(run.ground.estimators.front(), *run.prepared.scene().layout(),
                             run.ground.grounds.front().model, kNeighbourReach, kListedNeighbours, run.threads);
  std::vector<ContaminationRow> rows;
  rows.reserve(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t)
    rows.push_back({.id = targets[t].id,
                    .mag = targets[t].mag,
                    .spr_tot = targets[t].spr_tot,
                    .delta_mag = targets[t].causes.contamination,
                    .strongest = neighbours[t]});
  return rows;
}

/// Magnitudes of the analytic budget: every half magnitude that targets have.
std::vector<BudgetRow> budget_rows(const MeasuredRun& run) {
  const Scene& scene = run.prepared.scene();
  double bright = std::numeric_limits<double>::infinity();
  double faint = -bright;
  for (const std::size_t t : scene.targets()) {
    bright = std::min(bright, scene.stars()[t].magnitude.value());
    faint = std::max(faint, scene.stars()[t].magnitude.value());
  }
  std::vector<double> magnitudes;
  for (double m = std::floor(2.0 * bright) / 2.0; m <= faint + 0.5; m += 0.5) magnitudes.push_back(m);
  return analytic_budget(run.prepared.groups.size() > 1 ? run.configuration.mission : scene.mission(),
                         *psf_in_images(scene), magnitudes);
}

/// Light curves of clean targets spread over the magnitudes, read back from the file.
std::vector<ExampleLightCurve> example_light_curves(const std::filesystem::path& file,
                                                    std::span<const TargetMetrics> targets,
                                                    std::span<const double> reference) {
  std::vector<std::size_t> clean;
  for (std::size_t t = 0; t < targets.size(); ++t)
    if (is_clean(targets[t])) clean.push_back(t);
  if (clean.empty() || !std::filesystem::exists(file)) return {};
  std::ranges::stable_sort(clean, {}, [&](std::size_t t) { return targets[t].mag; });
  const LightCurveReader reader(file.string());
  std::vector<ExampleLightCurve> examples;
  const std::size_t count = std::min(kShownLightCurves, clean.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t t = clean[count == 1 ? 0 : i * (clean.size() - 1) / (count - 1)];
    const LightCurve curve = reader.read(t, 0);
    ExampleLightCurve example{.id = targets[t].id, .mag = targets[t].mag, .hours = {}, .deviation = {}};
    for (std::size_t k = 0; k < curve.time.size(); ++k) {
      example.hours.push_back(curve.time[k] / kSecondsPerHour);
      example.deviation.push_back(static_cast<float>(curve.flux[k] / reference[t] - 1.0));
    }
    examples.push_back(std::move(example));
  }
  return examples;
}

/// What jitter correction did, and what it brought.
std::vector<std::string> jitter_correction_notes(const MeasuredRun& run, std::span<const TargetMetrics> targets) {
  if (run.ground.corrections.front().empty()) return {};
  const AttitudeCorrection& correction = *run.ground.corrections.front().front().correction;
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> brightest;
  for (const TargetMetrics& t : targets)
    if (is_clean(t) && std::isfinite(t.nsr_1h_uncorrected.value)) brightest.push_back(t.mag);
  std::ranges::sort(brightest);
  constexpr std::size_t kShown = 100;  // in which motion shows the most
  const double limit = brightest.empty() ? 0.0 : brightest[std::min(kShown, brightest.size()) - 1];
  for (const TargetMetrics& t : targets)
    if (is_clean(t) && std::isfinite(t.nsr_1h_uncorrected.value) && t.mag <= limit) {
      before.push_back(t.nsr_1h_uncorrected.value);
      after.push_back(t.nsr_1h_measured.value);
    }
  std::string text = "motion was taken out of the light curves " + correction.description();
  if (!before.empty())
    text += fmt::format(
        "; the noise in {:g} s of the {} brightest unsaturated targets (to mag {:.2f}) fell from {:.4g} to "
        "{:.4g} ppm (medians, simulated cameras)",
        run.prepared.scene().mission().analysis.bin.value(), before.size(), limit, quantile(before, 0.5).value,
        quantile(after, 0.5).value);
  return {text};
}

/// Takes common trends out of the bin means, where the mission asks for it.  @returns what was done
std::optional<std::string> cotrend(const MeasuredRun& run, std::span<TargetMetrics> targets,
                                   const std::filesystem::path& file) {
  const Mission& mission = run.prepared.scene().mission();
  if (run.stream.bin_means.empty()) return std::nullopt;
  const Cotrending cotrending(run.stream.bin_means, run.stream.series, targets,
                              static_cast<std::size_t>(mission.photometry.cotrending));
  for (std::size_t t = 0; t < targets.size(); ++t) add_cotrended(targets[t], cotrending.left(t));
  cotrending.write(file, targets, mission.analysis.bin.value());
  return cotrending_note(cotrending, targets);
}

std::vector<std::string> warnings_of(const MeasuredRun& run, std::span<const TargetMetrics> targets) {
  std::vector<std::string> warnings = run.prepared.notes;
  for (const PreparedGroup& group : run.prepared.groups)
    for (const std::string& note : group.plan->approximations)
      if (std::ranges::find(warnings, note) == warnings.end()) warnings.push_back(note);
  const auto unmeasured = std::ranges::count_if(targets, [](const TargetMetrics& t) { return t.exposures == 0; });
  if (unmeasured > 0)
    warnings.push_back(
        fmt::format("{} of {} targets could not be measured; their flags say why", unmeasured, targets.size()));
  const auto saturated = std::ranges::count_if(
      targets, [](const TargetMetrics& t) { return (t.flags & measurement_flag::kSaturated) != 0; });
  if (saturated > 0) warnings.push_back(fmt::format("{} of {} targets are saturated", saturated, targets.size()));
  if (run.stream.lost_electrons > 0.0)
    warnings.push_back(
        fmt::format("blooming lost {:.3g} e- through the edges of the computed pixels", run.stream.lost_electrons));
  if (run.stream.clipped_pixels > 0)
    warnings.push_back(fmt::format("the ADC clipped {} pixel values", run.stream.clipped_pixels));
  return warnings;
}

}  // namespace

std::vector<TargetMetrics> target_metrics(const MeasuredRun& run, const RunSetup& setup) {
  const std::vector<PreparedGroup>& groups = run.prepared.groups;
  std::vector<std::vector<TruthStar>> truth;
  std::vector<double> shares;
  for (const PreparedGroup& group : groups) {
    truth.push_back(truth_of(*group.scene));
    shares.push_back(group.share);
  }
  const AttitudeSharing attitude(run.prepared);
  const bool is_corrected = !run.ground.corrections.front().empty();
  std::vector<TargetMetrics> targets;
  for (std::size_t t = 0; t < groups.front().targets.size(); ++t) {
    std::vector<GroupView> views;
    std::vector<TruthStar> stars;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      views.push_back({&run.ground.estimators[g][t], groups[g].share});
      stars.push_back(truth[g][groups[g].targets[t]]);
    }
    const StarEstimator estimator = mean_estimator(views);
    MotionNoise motion = mean_motion_noise(views, attitude.of_target(t), setup);
    if (is_corrected) {
      const MotionNoise error =
          mean_motion_noise(views, attitude_error_motion(run.prepared, run.ground.corrections, t), setup);
      motion = after_correction(motion, error, run.ground.corrections.front().front().correction->is_measured(),
                                setup.exposures_per_bin);
    }
    const PredictedNoise noise = predict_mean_noise(estimator, motion, setup);
    TargetMetrics target = predict_mean_target(mean_truth(stars, shares), estimator, noise, setup);
    add_measurement(target, run.stream.series[t], run.stream.reference[t], run.stream.flags[t], setup);
    if (is_corrected && t < run.stream.measured.size()) add_uncorrected(target, run.stream.measured[t]);
    targets.push_back(std::move(target));
  }
  return targets;
}

ReportedRun report_run(const std::filesystem::path& folder, const MeasuredRun& run) {
  const Mission& mission = run.prepared.scene().mission();
  const RunSetup setup = run_setup(mission);
  std::vector<TargetMetrics> targets = target_metrics(run, setup);
  create_folder(folder / "photometry");
  const std::optional<std::string> cotrended = cotrend(run, targets, folder / "photometry" / "cotrending.fits");
  write_mean_sources(folder / "photometry" / "sources.csv", run, targets);
  const std::vector<ContaminationRow> contamination = contamination_rows(run, targets);
  const std::vector<BudgetRow> budget = budget_rows(run);

  ReportedRun reported;
  const double bin_hours = mission.analysis.bin.value() / kSecondsPerHour;
  ReportInput input;
  input.title = fmt::format("{} targets around RA {:.4f}°, Dec {:.4f}°", targets.size(), mission.satellite.ra.value(),
                            mission.satellite.dec.value());
  input.requirement = plato_requirement(mission.telescope.cameras, bin_hours);
  input.verdict = verdict(targets, setup, bin_hours, input.requirement);
  input.setup = setup;
  input.bin_hours = bin_hours;
  input.passband = mission.telescope.zero_point_passband;
  input.targets = targets;
  input.contamination = contamination;
  input.budget = budget;
  input.plan = plan_text(run.prepared);
  for (const ResolvedParameter& p : run.configuration.parameters)
    input.configuration.push_back({p.path, p.value, p.unit, p.origin});
  for (const ComponentVersion& component : component_versions())
    input.provenance.emplace_back(component.name, component.version);
  input.provenance.emplace_back("seed", fmt::format("{}", mission.simulation.seed));
  input.warnings = warnings_of(run, targets);
  for (const std::string& note : jitter_correction_notes(run, targets)) input.warnings.push_back(note);
  if (cotrended) input.warnings.push_back(*cotrended);
  if (run.stream.first_frame.size() > 0) {
    input.image = run.stream.first_frame.view();
    input.image_caption =
        fmt::format("Exposure 0 of camera 1, {} x {} px", run.stream.first_frame.nx(), run.stream.first_frame.ny());
  }
  input.light_curves = example_light_curves(run.light_curves, targets, run.stream.reference);
  input.threads = run.threads;
  const WrittenReport written = write_report(folder, input);
  reported.index = written.index;
  reported.verdict = input.verdict;
  reported.warnings = input.warnings;
  reported.warnings.insert(reported.warnings.end(), written.problems.begin(), written.problems.end());
  return reported;
}

}  // namespace astroid
