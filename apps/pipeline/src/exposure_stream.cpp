#include "astroid/pipeline/exposure_stream.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "astroid/core/worker_pool.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/sim/simulator.hpp"
#include "folders.hpp"
#include "image_files.hpp"

namespace astroid {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What one worker owns.
struct Worker {
  ExposureState state;
  std::vector<double> flux;
  std::vector<std::uint32_t> flags;
  double simulate = 0.0, measure = 0.0, images = 0.0;
  std::int64_t images_written = 0;
};

/// One block of exposures of one camera: [exposure][target] as measured, then [target][exposure].
struct Block {
  std::vector<float> by_exposure;
  std::vector<float> by_target;
  std::vector<std::uint32_t> flags;  // [exposure][target]
  std::vector<double> lost;          // [exposure]
  std::vector<std::int64_t> clipped;
};

/// Takes the mesh background out of a measured frame; written images keep theirs.
void subtract_mesh(Frame& frame, const PhotometrySettings& settings) {
  for (std::size_t r = 0; r < frame.pixels.layout().regions().size(); ++r) {
    const BackgroundMap map(frame, r, {.cell = settings.mesh});
    subtract_background(frame, r, map);
  }
}

/// Exposures in a block: as many as keep a block of deviations below this size, at most a thousand or so (DESIGN: about
/// 1024).
constexpr std::size_t kBlockBytes = std::size_t{192} << 20;
constexpr std::int64_t kLongestBlock = 1024;

std::int64_t block_length(std::size_t targets) {
  const std::size_t bytes_per_exposure =
      std::max<std::size_t>(1, targets) * (2 * sizeof(float) + sizeof(std::uint32_t));
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(kBlockBytes / bytes_per_exposure), 16, kLongestBlock);
}

void transpose(const Block& block, std::size_t targets, std::size_t count, std::size_t first, std::size_t last,
               std::vector<float>& out) {
  for (std::size_t t = first; t < last; ++t)
    for (std::size_t k = 0; k < count; ++k) out[t * count + k] = block.by_exposure[k * targets + t];
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

}  // namespace

StreamResult stream_exposures(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const Plan>& plan,
                              const std::vector<StarEstimator>& estimators, const StreamOptions& options) {
  const Clock::time_point begin = Clock::now();
  const Mission& mission = scene->mission();
  const int cameras = mission.telescope.simulated_cameras;
  const std::int64_t exposures = mission.simulation.exposures;
  const std::size_t targets = estimators.size();
  const bool measures = targets > 0;

  StreamResult result;
  result.reference.reserve(targets);
  for (const StarEstimator& e : estimators) {
    // What the estimator expects; a target without light is measured against one electron.
    const double expected = e.budget.target + e.budget.contaminants;
    result.reference.push_back(expected > 0.0 ? expected : 1.0);
  }
  result.flags.assign(targets, 0);
  result.flagged_share.assign(targets, 0.0);
  std::vector<std::int64_t> flagged(targets, 0);

  std::vector<Simulator> simulators;
  simulators.reserve(static_cast<std::size_t>(cameras));
  const std::shared_ptr<const AttitudeSeries> attitude = make_attitude_series(*scene, *plan);
  for (int camera = 0; camera < cameras; ++camera) simulators.emplace_back(scene, plan, camera, attitude);
  const EstimatorSet set(estimators, mission.ccd.gain, mission.ccd.bias);
  SeriesStatistics statistics(targets,
                              std::max<std::int64_t>(2, static_cast<std::int64_t>(scene->summary().exposures_per_bin)));
  std::optional<LightCurveWriter> light_curves;
  if (measures && !options.folder.empty() && mission.output.light_curves != LightCurveOutput::kNone) {
    create_folder(options.folder / "photometry");
    light_curves.emplace((options.folder / "photometry" / "lightcurves.fits").string(),
                         LightCurveHeader{.exposures = exposures,
                                          .cameras = cameras,
                                          .start_mjd = mission.simulation.start_mjd,
                                          .cycle = mission.simulation.cycle.value(),
                                          .exposure_time = mission.simulation.exposure_time.value(),
                                          .history = history_of(*plan, *scene)},
                         light_curve_stars(*scene, estimators, result.reference));
  }
  const ImageFiles images(*scene, *plan, options.folder);

  const int threads = options.threads > 0 ? options.threads : available_threads();
  std::vector<Worker> workers(static_cast<std::size_t>(threads));
  for (Worker& worker : workers) {
    worker.state = simulators.front().make_state();
    worker.flux.resize(targets);
    worker.flags.resize(targets);
  }
  result.timings.prepare = seconds_since(begin);

  const std::int64_t length = std::min(exposures, measures ? block_length(targets) : kLongestBlock);
  const auto block_size = static_cast<std::size_t>(length);
  Block block;
  block.by_exposure.resize(block_size * targets);
  block.by_target.resize(block_size * targets);
  block.flags.resize(block_size * targets);
  block.lost.resize(block_size);
  block.clipped.resize(block_size);
  std::vector<double> mean_of_cameras(cameras > 1 ? block_size * targets : 0);
  std::vector<float> combined(cameras > 1 ? block_size * targets : 0);
  std::atomic<std::int64_t> done{0};

  for (std::int64_t first = 0; first < exposures; first += length) {
    const auto count = static_cast<std::size_t>(std::min(length, exposures - first));
    std::ranges::fill(mean_of_cameras, 0.0);
    for (int camera = 0; camera < cameras; ++camera) {
      const Simulator& simulator = simulators[static_cast<std::size_t>(camera)];
      parallel_for(threads, count, [&](std::size_t worker_index, std::size_t k) {
        Worker& worker = workers[worker_index];
        const std::int64_t exposure = first + static_cast<std::int64_t>(k);
        Clock::time_point start = Clock::now();
        if (images.dumps(camera, exposure)) {
          simulator.simulate(exposure, worker.state, images.step_writer(camera, exposure));
        } else {
          simulator.simulate(exposure, worker.state);
        }
        worker.simulate += seconds_since(start);
        block.lost[k] = worker.state.lost_electrons;
        block.clipped[k] = worker.state.clipped_pixels;
        if (images.writes(camera, exposure)) {
          start = Clock::now();
          images.write(worker.state.frame);
          ++worker.images_written;
          worker.images += seconds_since(start);
        }
        if (camera == 0 && exposure == 0) result.first_frame = largest_region(worker.state.frame);
        if (measures) {
          start = Clock::now();
          if (mission.photometry.background == BackgroundMethod::kMesh)
            subtract_mesh(worker.state.frame, mission.photometry);
          set.apply(worker.state.frame, worker.flux, worker.flags);
          for (std::size_t t = 0; t < targets; ++t) {
            block.by_exposure[k * targets + t] = static_cast<float>(worker.flux[t] / result.reference[t] - 1.0);
            block.flags[k * targets + t] = worker.flags[t];
          }
          worker.measure += seconds_since(start);
        }
        const std::int64_t n = ++done;
        if (options.progress) options.progress(n, exposures * cameras);
      });
      for (std::size_t k = 0; k < count; ++k) {
        result.lost_electrons += block.lost[k];
        result.clipped_pixels += block.clipped[k];
      }
      if (!measures) continue;

      // From here on star by star: every star belongs to one worker, so no order depends on the threads.
      const Clock::time_point start = Clock::now();
      constexpr std::size_t kStarsPerTask = 256;
      const std::size_t tasks = (targets + kStarsPerTask - 1) / kStarsPerTask;
      parallel_for(threads, tasks, [&](std::size_t /*worker*/, std::size_t task) {
        const std::size_t begin_star = task * kStarsPerTask;
        const std::size_t end_star = std::min(targets, begin_star + kStarsPerTask);
        transpose(block, targets, count, begin_star, end_star, block.by_target);
        for (std::size_t t = begin_star; t < end_star; ++t) {
          for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t flag = block.flags[k * targets + t];
            result.flags[t] |= flag;
            flagged[t] += flag != 0 ? 1 : 0;
          }
          const std::span<const float> series(&block.by_target[t * count], count);
          if (cameras == 1) {
            statistics.add(t, first, series);
            continue;
          }
          for (std::size_t k = 0; k < count; ++k)
            mean_of_cameras[t * count + k] += static_cast<double>(series[k]) / cameras;
          if (camera + 1 < cameras) continue;
          for (std::size_t k = 0; k < count; ++k)
            combined[t * count + k] = static_cast<float>(mean_of_cameras[t * count + k]);
          statistics.add(t, first, std::span<const float>(&combined[t * count], count));
        }
      });
      result.timings.statistics += seconds_since(start);
      if (light_curves) {
        const Clock::time_point write_start = Clock::now();
        light_curves->write_block(camera + 1, first, count, std::span(block.by_target).first(count * targets));
        std::vector<LightCurveFlag> set_flags;
        for (std::size_t k = 0; k < count; ++k)
          for (std::size_t t = 0; t < targets; ++t) {
            // What holds for every exposure stands in the table of stars.
            const std::uint32_t flag = block.flags[k * targets + t] & ~estimators[t].flags;
            if (flag != 0)
              set_flags.push_back({.camera = static_cast<std::uint32_t>(camera + 1),
                                   .star = static_cast<std::uint32_t>(t),
                                   .exposure = first + static_cast<std::int64_t>(k),
                                   .flags = flag});
          }
        light_curves->add_flags(set_flags);
        result.timings.light_curves += seconds_since(write_start);
      }
    }
  }
  if (light_curves) {
    const Clock::time_point start = Clock::now();
    light_curves->commit();
    result.timings.light_curves += seconds_since(start);
  }
  result.series = statistics.summaries();
  for (std::size_t t = 0; t < targets; ++t)
    result.flagged_share[t] = static_cast<double>(flagged[t]) / static_cast<double>(exposures * cameras);
  for (const Worker& worker : workers) {
    result.timings.simulate += worker.simulate;
    result.timings.measure += worker.measure;
    result.timings.images += worker.images;
    result.images_written += worker.images_written;
  }
  for (std::size_t i = 0; i < plan->effects.size(); ++i) {
    if (!plan->effects[i].need.needed) continue;
    double seconds = 0.0;
    for (const Worker& worker : workers) seconds += worker.state.effect_seconds[i];
    result.effect_seconds.emplace_back(plan->effects[i].effect->spec().name, seconds);
  }
  result.timings.wall = seconds_since(begin);
  return result;
}

}  // namespace astroid
