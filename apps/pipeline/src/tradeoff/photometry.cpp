#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/bounds.hpp"
#include "astroid/core/statistics/quantiles.hpp"
#include "astroid/pipeline/ground.hpp"
#include "report_run.hpp"
#include "sweeps.hpp"

namespace astroid::tradeoff {

namespace {

struct Method {
  PhotometryMethod method;
  const char* name;
};
constexpr Method kMethods[] = {{PhotometryMethod::kAperture, "aperture"},
                               {PhotometryMethod::kMask, "mask"},
                               {PhotometryMethod::kWeighted, "weighted"},
                               {PhotometryMethod::kPsf, "psf"}};

/// Smallest possible relative noise of one exposure of one camera, the star alone and everything else known.
double bound(const Scene& scene, const SceneStar& star, double background_variance) {
  constexpr int kReach = 10;  // px
  const Rectangle box{static_cast<int>(std::lround(star.position.x)) - kReach,
                      static_cast<int>(std::lround(star.position.y)) - kReach, 2 * kReach + 1, 2 * kReach + 1};
  std::vector<double> fractions(box.size());
  scene.psf().integrate(star.position, box, fractions);
  return flux_bound(fractions, {star.electrons, background_variance}) / star.electrons;
}

TradeoffRow measure(const ResolvedConfiguration& configuration, const PreparedRun& run, const Method& method,
                    int threads, bool chosen) {
  const Scene& scene = run.scene();
  const GroundSegment ground = perfect_ground_segment(run);
  const StreamResult stream =
      stream_exposures(stream_groups(run, ground), {.threads = threads, .folder = {}, .progress = {}});
  const std::vector<TargetMetrics> targets = target_metrics({.configuration = configuration,
                                                             .prepared = run,
                                                             .ground = ground,
                                                             .stream = stream,
                                                             .light_curves = {},
                                                             .threads = threads},
                                                            run_setup(scene.mission()));
  const PixelNoise noise = expected_pixel_noise(scene.mission());
  const double cameras = scene.mission().telescope.simulated_cameras;
  std::vector<double> ratio;
  std::vector<double> bias;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TargetMetrics& target = targets[t];
    const SceneStar& star = scene.stars()[run.groups.front().targets[t]];
    // By what is measured, beyond what is known of light that the aperture misses.
    const double excess = target.delta_mag - target.causes.aperture_loss;
    constexpr double kPerMagnitude = 0.4 * 2.302585092994046;
    constexpr std::uint32_t kUnusable =
        measurement_flag::kSaturated | measurement_flag::kEdge | measurement_flag::kOutside | measurement_flag::kNoFlux;
    if ((target.flags & kUnusable) != 0 || !std::isfinite(excess) || !std::isfinite(target.nsr_exposure_measured.value))
      continue;
    bias.push_back(1e6 * std::abs(std::expm1(-kPerMagnitude * excess)));
    ratio.push_back(target.nsr_exposure_measured.value * std::sqrt(cameras) / bound(scene, star, noise.variance()));
  }
  TradeoffRow row{.sweep = Sweep::kPhotometry,
                  .setting = method.name,
                  .parameter = fmt::format("Photometry/Method={}", method.name),
                  .chosen = chosen};
  if (ratio.empty()) return row;
  row.noise_over_bound = quantile(ratio, 0.5).value;
  row.error_rms = quantile(bias, 0.5).value;
  row.error_max = quantile(bias, 0.95).value;
  const double measured =
      static_cast<double>(targets.size()) * static_cast<double>(scene.mission().simulation.exposures) * cameras;
  constexpr double kStars = 1000.0;
  row.seconds = kStars * stream.timings.measure / measured;
  return row;
}

}  // namespace

std::vector<TradeoffRow> sweep_photometry(const ResolvedConfiguration& configuration, const StarCatalogue& catalogue,
                                          std::int64_t exposures, int threads) {
  std::vector<TradeoffRow> rows;
  for (const Method& method : kMethods) {
    Mission mission = configuration.mission;
    mission.simulation.exposures = std::min(mission.simulation.exposures, exposures);
    mission.photometry.method = method.method;
    const PreparedRun run = prepare_run(mission, catalogue);
    if (run.groups.front().targets.empty()) break;
    rows.push_back(
        measure(configuration, run, method, threads, method.method == configuration.mission.photometry.method));
  }
  return rows;
}

}  // namespace astroid::tradeoff
