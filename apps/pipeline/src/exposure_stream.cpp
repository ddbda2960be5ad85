#include "astroid/pipeline/exposure_stream.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

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
std::vector<double> reference_of(const std::vector<StarEstimator>& estimators) {
  std::vector<double> reference;
  reference.reserve(estimators.size());
  for (const StarEstimator& e : estimators) {
    // What the estimator expects; a target without light is measured against one electron.
    const double expected = e.budget.target + e.budget.contaminants;
    reference.push_back(expected > 0.0 ? expected : 1.0);
  }
  return reference;
}

std::vector<std::uint32_t> own_flags_of(const std::vector<StarEstimator>& estimators) {
  std::vector<std::uint32_t> flags;
  flags.reserve(estimators.size());
  for (const StarEstimator& e : estimators) flags.push_back(e.flags);
  return flags;
}

std::vector<LightCurveStar> light_curve_stars(const Scene& scene, const std::vector<StarEstimator>& estimators,
                                              const std::vector<double>& reference) {
  std::vector<LightCurveStar> stars;
  for (std::size_t t = 0; t < estimators.size(); ++t) {
    const SceneStar& star = scene.stars()[estimators[t].star];
    stars.push_back({.id = star.id,
                     .magnitude = star.magnitude.value(),
                     .x = star.position.x,
                     .y = star.position.y,
                     .reference = reference[t],
                     .nsr_exposure = std::sqrt(estimators[t].budget.variance()) / reference[t],
                     .flags = estimators[t].flags});
  }
  return stars;
}

/// photometry/lightcurves.fits, where the configuration asks for it.
std::unique_ptr<LightCurveWriter> open_light_curves(const Scene& scene, const Plan& plan,
                                                    const std::vector<StarEstimator>& estimators,
                                                    const std::vector<double>& reference,
                                                    const std::filesystem::path& folder) {
  const Mission& mission = scene.mission();
  if (estimators.empty() || folder.empty() || mission.output.light_curves == LightCurveOutput::kNone) return nullptr;
  create_folder(folder / "photometry");
  return std::make_unique<LightCurveWriter>((folder / "photometry" / "lightcurves.fits").string(),
                                            LightCurveHeader{.exposures = mission.simulation.exposures,
                                                             .cameras = mission.telescope.simulated_cameras,
                                                             .start_mjd = mission.simulation.start_mjd,
                                                             .cycle = mission.simulation.cycle.value(),
                                                             .exposure_time = mission.simulation.exposure_time.value(),
                                                             .history = history_of(plan, scene)},
                                            light_curve_stars(scene, estimators, reference));
}

std::vector<Simulator> make_simulators(const std::shared_ptr<const Scene>& scene,
                                       const std::shared_ptr<const Plan>& plan) {
  const int cameras = scene->mission().telescope.simulated_cameras;
  const std::shared_ptr<const AttitudeSeries> attitude = make_attitude_series(*scene, *plan);
  std::vector<Simulator> simulators;
  simulators.reserve(static_cast<std::size_t>(cameras));
  for (int camera = 0; camera < cameras; ++camera) simulators.emplace_back(scene, plan, camera, attitude);
  return simulators;
}

/// The loop: while workers fill one block with exposures, they also empty the block before it star by star.
class Stream {
 public:
  Stream(const StreamInput& input, SeriesStage& series, int threads, std::int64_t block_length,
         std::size_t batch_length)
      : series_(series),
        threads_(threads),
        batch_length_(batch_length),
        blocks_{FluxBlock(input.estimators.size(), static_cast<std::size_t>(block_length)),
                FluxBlock(input.estimators.size(), static_cast<std::size_t>(block_length))},
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
  void add_to(StreamResult& result, const Plan& plan) {
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
    for (std::size_t i = 0; i < plan.effects.size(); ++i) {
      if (!plan.effects[i].need.needed) continue;
      double seconds = 0.0;
      for (const ExposureWorker& worker : workers_) seconds += worker.state().effect_seconds[i];
      wall += seconds;
      result.effect_seconds.emplace_back(plan.effects[i].effect->spec().name, seconds);
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

StreamResult stream_exposures(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const Plan>& plan,
                              const std::vector<StarEstimator>& estimators, const StreamOptions& options) {
  const Clock::time_point begin = Clock::now();
  const Mission& mission = scene->mission();
  const std::int64_t exposures = mission.simulation.exposures;
  const int cameras = mission.telescope.simulated_cameras;
  const int threads = options.threads > 0 ? options.threads : available_threads();

  StreamResult result;
  result.reference = reference_of(estimators);
  const std::vector<std::uint32_t> own_flags = own_flags_of(estimators);
  const std::vector<Simulator> simulators = make_simulators(scene, plan);
  const EstimatorSet set(estimators, mission.ccd.gain, mission.ccd.bias);
  const FrameCalibration calibration(*scene->layout(), calibration_model(mission));
  const ImageFiles images(*scene, *plan, options.folder);
  const std::unique_ptr<LightCurveWriter> light_curves =
      open_light_curves(*scene, *plan, estimators, result.reference, options.folder);

  const std::int64_t length = block_length(exposures, estimators.size(), cameras, options.longest_block);
  const std::size_t batch = estimators.empty() ? 1 : batch_length(scene->layout()->size());
  const std::int64_t per_bin = std::max<std::int64_t>(2, static_cast<std::int64_t>(scene->summary().exposures_per_bin));
  SeriesStage series(own_flags, cameras, per_bin, static_cast<std::size_t>(length), light_curves.get());
  Stream stream({.mission = mission,
                 .simulators = simulators,
                 .calibration = calibration,
                 .estimators = set,
                 .reference = result.reference,
                 .own_flags = own_flags,
                 .images = images,
                 .progress = options.progress},
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
  result.flags = series.flags();
  result.flagged_share = series.flagged_share();
  stream.add_to(result, *plan);
  result.timings.wall = seconds_since(begin);
  return result;
}

}  // namespace astroid
