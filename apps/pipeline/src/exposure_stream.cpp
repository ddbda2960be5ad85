#include "astroid/pipeline/exposure_stream.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "astroid/analysis/group_mean.hpp"
#include "astroid/core/camera_groups.hpp"
#include "astroid/core/worker_pool.hpp"
#include "astroid/pipeline/ground.hpp"
#include "exposure_worker.hpp"
#include "flux_block.hpp"
#include "folders.hpp"
#include "image_files.hpp"
#include "series_stage.hpp"
#include "stage_clock.hpp"
#include "stream_sizes.hpp"

namespace astroid {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the fluxes of each target are relative to, e- per exposure.
std::vector<double> reference_of(std::span<const StarEstimator> estimators) {
  std::vector<double> reference;
  reference.reserve(estimators.size());
  for (const StarEstimator& e : estimators) {
    // What the estimator expects; a target without light is measured against one electron.
    const double expected = e.budget.target + e.budget.contaminants;
    reference.push_back(expected > 0.0 ? expected : 1.0);
  }
  return reference;
}

std::vector<std::uint32_t> own_flags_of(std::span<const StarEstimator> estimators) {
  std::vector<std::uint32_t> flags;
  flags.reserve(estimators.size());
  for (const StarEstimator& e : estimators) flags.push_back(e.flags);
  return flags;
}

/// What measures the mean of all cameras.
std::vector<StarEstimator> mean_estimators(std::span<const StreamGroup> groups) {
  std::vector<StarEstimator> means;
  std::vector<GroupView> views(groups.size());
  for (std::size_t t = 0; t < groups.front().estimators.size(); ++t) {
    for (std::size_t g = 0; g < groups.size(); ++g) views[g] = {&groups[g].estimators[t], groups[g].share};
    means.push_back(mean_estimator(views));
  }
  return means;
}

/// @param responses  to the attitude that is taken out; empty: none is.
std::vector<LightCurveStar> light_curve_stars(const Scene& scene, std::span<const StarEstimator> estimators,
                                              std::span<const AttitudeResponse> responses) {
  const std::vector<double> reference = reference_of(estimators);
  std::vector<LightCurveStar> stars;
  for (std::size_t t = 0; t < estimators.size(); ++t) {
    const SceneStar& star = scene.stars()[estimators[t].star];
    stars.push_back({.id = star.id,
                     .magnitude = star.magnitude.value(),
                     .x = star.position.x,
                     .y = star.position.y,
                     .reference = reference[t],
                     .nsr_exposure = std::sqrt(estimators[t].budget.variance()) / reference[t],
                     .flags = estimators[t].flags,
                     .response = responses.empty() ? AttitudeResponse{} : responses[t]});
  }
  return stars;
}

/// What the table of stars tells of the correction: nothing where the masks, and with them the responses, change.
std::span<const AttitudeResponse> responses_of(const StreamGroup& group) {
  return group.corrections.size() == 1 ? group.corrections.front().correction->responses()
                                       : std::span<const AttitudeResponse>();
}

/// Of the mean of all cameras.
std::vector<AttitudeResponse> mean_responses(std::span<const StreamGroup> groups) {
  std::vector<AttitudeResponse> mean(responses_of(groups.front()).size());
  for (const StreamGroup& group : groups)
    for (std::size_t t = 0; t < mean.size(); ++t) {
      const AttitudeResponse& response = responses_of(group)[t];
      mean[t].yaw += group.share * response.yaw;
      mean[t].pitch += group.share * response.pitch;
      mean[t].roll += group.share * response.roll;
    }
  return mean;
}

/// photometry/lightcurves.fits, where the configuration asks for it.
std::unique_ptr<LightCurveWriter> open_light_curves(std::span<const StreamGroup> groups,
                                                    std::span<const std::size_t> group_of,
                                                    std::span<const StarEstimator> mean,
                                                    const std::filesystem::path& folder) {
  const Scene& scene = *groups.front().scene;
  const Mission& mission = scene.mission();
  if (mean.empty() || folder.empty() || mission.output.light_curves == LightCurveOutput::kNone) return nullptr;
  create_folder(folder / "photometry");
  LightCurveHeader header{.exposures = mission.simulation.exposures,
                          .cameras = mission.telescope.simulated_cameras,
                          .start_mjd = mission.simulation.start_mjd,
                          .cycle = mission.simulation.cycle.value(),
                          .exposure_time = mission.simulation.exposure_time.value(),
                          .history = history_of(*groups.front().plan, scene),
                          .is_corrected = !groups.front().corrections.empty(),
                          .has_responses = groups.front().corrections.size() == 1,
                          .line_time = line_time(mission).value()};
  for (const std::size_t group : group_of) {
    header.group.push_back(static_cast<int>(group));
    header.stagger.push_back(groups[group].scene->mission().simulation.stagger.value());
  }
  std::vector<std::vector<LightCurveStar>> stars_of_groups;
  if (groups.size() > 1)
    for (const StreamGroup& group : groups)
      stars_of_groups.push_back(light_curve_stars(*group.scene, group.estimators, responses_of(group)));
  return std::make_unique<LightCurveWriter>((folder / "photometry" / "lightcurves.fits").string(), header,
                                            light_curve_stars(scene, mean, mean_responses(groups)),
                                            std::move(stars_of_groups));
}

/// The group of each simulated camera.
std::vector<std::size_t> groups_of_cameras(std::span<const StreamGroup> groups) {
  const TelescopeSettings& telescope = groups.front().scene->mission().telescope;
  std::vector<std::size_t> group_of;
  group_of.reserve(static_cast<std::size_t>(telescope.simulated_cameras));
  for (int camera = 0; camera < telescope.simulated_cameras; ++camera)
    group_of.push_back(groups.size() > 1 ? static_cast<std::size_t>(group_of_camera(telescope, camera)) : 0);
  return group_of;
}

std::vector<Simulator> make_simulators(std::span<const StreamGroup> groups, std::span<const std::size_t> group_of) {
  std::vector<std::shared_ptr<const AttitudeSeries>> attitudes;
  for (const StreamGroup& group : groups) attitudes.push_back(make_attitude_series(*group.scene, *group.plan));
  std::vector<Simulator> simulators;
  simulators.reserve(group_of.size());
  for (std::size_t camera = 0; camera < group_of.size(); ++camera) {
    const StreamGroup& group = groups[group_of[camera]];
    simulators.emplace_back(group.scene, group.plan, static_cast<int>(camera), attitudes[group_of[camera]]);
  }
  return simulators;
}

/// Flags that hold for every exposure, whichever estimators measure it.
std::vector<std::uint32_t> own_flags_of(const StreamGroup& group) {
  std::vector<std::uint32_t> flags = own_flags_of(group.estimators);
  for (const EstimatorRefresh& refresh : group.refreshes)
    for (std::size_t t = 0; t < flags.size(); ++t) flags[t] &= refresh.estimators[t].flags;
  return flags;
}

std::vector<GroupInput> group_inputs(std::span<const StreamGroup> groups, const std::filesystem::path& folder) {
  std::vector<GroupInput> inputs;
  inputs.reserve(groups.size());
  for (const StreamGroup& group : groups) {
    const Mission& mission = group.scene->mission();
    std::vector<EstimatorStretch> stretches;
    const auto add = [&](std::int64_t first, std::span<const StarEstimator> estimators) {
      stretches.push_back(
          {first, EstimatorSet(estimators, mission.ccd.gain, mission.ccd.bias), reference_of(estimators)});
    };
    add(0, group.estimators);
    for (const EstimatorRefresh& refresh : group.refreshes) add(refresh.first, refresh.estimators);
    inputs.push_back({.mission = mission,
                      .calibration = FrameCalibration(*group.scene->layout(), calibration_model(mission)),
                      .stretches = std::move(stretches),
                      .own_flags = own_flags_of(group),
                      .corrections = group.corrections,
                      .images = ImageFiles(*group.scene, *group.plan, folder)});
  }
  return inputs;
}

/// The loop: while workers fill one block with exposures, they also empty the block before it star by star.
class Stream {
 public:
  Stream(const StreamInput& input, SeriesStage& series, int threads, std::int64_t block_length,
         std::size_t batch_length)
      : series_(series),
        threads_(threads),
        batch_length_(batch_length),
        blocks_{FluxBlock(input.groups.front().own_flags.size(), static_cast<std::size_t>(block_length)),
                FluxBlock(input.groups.front().own_flags.size(), static_cast<std::size_t>(block_length))},
        lost_electrons_(input.simulators.size()) {
    workers_.reserve(static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i) workers_.emplace_back(input, batch_length);
  }

  /// Makes and measures exposures of one camera, and finishes those of the call before.  @param count  0: only finishes
  void pass(int camera, std::int64_t first, std::size_t count) {
    FluxBlock& done = blocks_[passes_ % 2];
    FluxBlock& next = blocks_[(passes_ + 1) % 2];
    ++passes_;
    next.begin(camera, first, count);
    series_.begin(done);
    const std::size_t tasks = series_.tasks(done);
    const std::vector<Batch> batches = divide_into_batches(count, batch_length_, threads_);
    parallel_for(threads_, tasks + batches.size(), [&](std::size_t worker, std::size_t item) {
      if (item < tasks)
        series_.run(item, done, workers_[worker].seconds());
      else
        workers_[worker].run(batches[item - tasks], next, exposures_done_);
    });
    series_.end(done, flags_);
    flags_.clear();
    for (ExposureWorker& worker : workers_) worker.take_flags(flags_);
    for (const double lost : next.lost()) lost_electrons_[static_cast<std::size_t>(camera)] += lost;
    for (const std::int64_t clipped : next.clipped()) clipped_pixels_ += clipped;
  }

  /// Adds what the workers counted to a result.
  void add_to(StreamResult& result, std::span<const StreamGroup> groups) {
    for (const double lost : lost_electrons_) result.lost_electrons += lost;
    result.clipped_pixels = clipped_pixels_;
    for (ExposureWorker& worker : workers_) {
      result.timings.simulate += worker.seconds().simulate;
      result.timings.measure += worker.seconds().measure;
      result.timings.images += worker.seconds().images;
      result.timings.statistics += worker.seconds().statistics;
      result.timings.light_curves += worker.seconds().light_curves;
      result.images_written += worker.images_written();
      if (worker.first_frame().size() > 0) result.first_frame = std::move(worker.first_frame());
    }
    // Effects take wall time, too short for a CPU clock; their shares of it are put to the CPU time of all simulation.
    double wall = 0.0;
    for (std::size_t i = 0; i < groups.front().plan->effects.size(); ++i) {
      const auto runs = [i](const StreamGroup& group) { return group.plan->effects[i].need.needed; };
      if (std::ranges::none_of(groups, runs)) continue;
      double seconds = 0.0;
      for (const ExposureWorker& worker : workers_) seconds += worker.effect_seconds()[i];
      wall += seconds;
      result.effect_seconds.emplace_back(groups.front().plan->effects[i].effect->spec().name, seconds);
    }
    for (auto& [name, seconds] : result.effect_seconds)
      seconds = wall > 0.0 ? seconds / wall * result.timings.simulate : 0.0;
  }

 private:
  SeriesStage& series_;
  int threads_;
  std::size_t batch_length_;
  std::array<FluxBlock, 2> blocks_;
  std::size_t passes_ = 0;
  std::vector<ExposureWorker> workers_;
  std::vector<LightCurveFlag> flags_;  // of the block that was filled last
  std::atomic<std::int64_t> exposures_done_{0};
  std::vector<double> lost_electrons_;  // by camera, so that their order does not depend on the blocks
  std::int64_t clipped_pixels_ = 0;
};

}  // namespace

StreamResult stream_exposures(std::span<const StreamGroup> groups, const StreamOptions& options) {
  const Clock::time_point begin = Clock::now();
  const Mission& mission = groups.front().scene->mission();
  const std::int64_t exposures = mission.simulation.exposures;
  const int threads = options.threads > 0 ? options.threads : available_threads();

  StreamResult result;
  const std::vector<StarEstimator> mean = mean_estimators(groups);
  result.reference = reference_of(mean);
  const std::vector<std::size_t> group_of = groups_of_cameras(groups);
  const auto cameras = static_cast<int>(group_of.size());
  const std::vector<Simulator> simulators = make_simulators(groups, group_of);
  const std::vector<GroupInput> inputs = group_inputs(groups, options.folder);
  const std::unique_ptr<LightCurveWriter> light_curves = open_light_curves(groups, group_of, mean, options.folder);

  const std::int64_t length = block_length(exposures, mean.size(), cameras, options.longest_block);
  std::size_t pixels = 0;
  for (const StreamGroup& group : groups) pixels = std::max(pixels, group.scene->layout()->size());
  const std::size_t batch = mean.empty() ? 1 : batch_length(pixels);
  const std::int64_t per_bin =
      std::max<std::int64_t>(2, static_cast<std::int64_t>(groups.front().scene->summary().exposures_per_bin));
  std::vector<std::vector<std::uint32_t>> own_flags;
  own_flags.reserve(group_of.size());
  std::vector<std::span<const CorrectionStretch>> corrections;
  for (const std::size_t group : group_of) {
    own_flags.push_back(inputs[group].own_flags);
    if (!inputs[group].corrections.empty()) corrections.push_back(inputs[group].corrections);
  }
  SeriesStage series(std::move(own_flags), std::move(corrections), per_bin, mission.photometry.cotrending > 0,
                     static_cast<std::size_t>(length), light_curves.get());
  Stream stream({.simulators = simulators, .group_of = group_of, .groups = inputs, .progress = options.progress},
                series, threads, length, batch);
  result.timings.prepare = seconds_since(begin);

  for (std::int64_t first = 0; first < exposures; first += length)
    for (int camera = 0; camera < cameras; ++camera)
      stream.pass(camera, first, static_cast<std::size_t>(std::min(length, exposures - first)));
  stream.pass(0, exposures, 0);
  if (light_curves) {
    StageClock clock;
    light_curves->commit(Durability::kWithFolder);  // of the run, which is synchronised as a whole
    clock.charge(result.timings.light_curves);
  }

  result.series = series.summaries();
  result.bin_means = series.bin_means(exposures);
  result.measured = series.measured_summaries();
  result.flags = series.flags();
  result.flagged_share = series.flagged_share();
  stream.add_to(result, groups);
  result.timings.wall = seconds_since(begin);
  return result;
}

StreamResult stream_exposures(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const Plan>& plan,
                              const std::vector<StarEstimator>& estimators, const StreamOptions& options) {
  const StreamGroup all{.scene = scene, .plan = plan, .estimators = estimators};
  return stream_exposures({&all, 1}, options);
}

}  // namespace astroid
