#include "plan_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "astroid/core/math.hpp"
#include "astroid/sim/rolling_shutter.hpp"
#include "effects/persistence.hpp"

namespace astroid {

namespace {

constexpr double kShare = 0.1;  // of the tolerances

bool varies(const Plan& plan) {
  return std::ranges::any_of(plan.effects, [](const PlannedEffect& e) {
    return e.need.needed && e.effect->spec().role == ImageRole::kVaryingLight;
  });
}

/// What it changes to take an exposure for another one so many seconds before, as far as it is released later.
struct MemoryError {
  double rms = 0.0;   ///< by noise of the pointing, of the brightest target, relative
  double bias = 0.0;  ///< by drift and by light that varies, e- per exposure
};
MemoryError memory_error(const Scene& scene, const Plan& plan, double released, double delay) {
  const SceneSummary& s = scene.summary();
  const CmosSettings& cmos = s.mission->cmos;
  const double moved = (s.drift_px_per_second + s.aberration_px_per_second) * delay;
  double changed = s.brightest_target_electrons * std::min(1.0, s.psf.gradient * moved);
  if (plan.runs("variable-stars")) changed += s.largest_variation;
  if (plan.runs("telegraph-pixels")) changed += (cmos.telegraph_current * s.mission->simulation.exposure_time).value();
  return {.rms = released * 2.0 * s.psf.gradient * s.attitude_rms_px, .bias = released * changed};
}

}  // namespace

void plan_memory(const Scene& scene, Plan& plan) {
  if (!plan.runs("persistence")) return;
  const PersistenceKernel kernel = persistence_kernel(scene.mission());
  const SceneSummary& s = scene.summary();
  const double released = kernel.released_within(kernel.reach());
  std::int64_t& block = plan.knobs.memory_block;
  if (plan.still && !varies(plan)) {
    block = plan.epoch_exposures;  // of which all exposures have the same image
    return;
  }
  constexpr std::int64_t kMostImages = 32;
  const double cycle = s.mission->simulation.cycle.value();
  const auto error = [&] { return memory_error(scene, plan, released, static_cast<double>(block) * cycle); };
  const double flux = s.brightest_target_electrons;
  const auto is_small = [&](const MemoryError& e) {
    const bool quiet = !(flux > 0.0) || e.rms * e.rms <= kShare * kVarianceTolerance * s.relative_variance_in_bin(flux);
    return quiet && e.bias <= kShare * s.tightest_tolerance();
  };
  block = 1;
  while (block < kernel.reach()) block *= 2;
  while (block > 1 && !is_small(error())) block /= 2;
  while (kernel.reach() / block > kMostImages) block *= 2;
  if (block == 1) return;
  plan.approximations.push_back(
      fmt::format("what is released of the charge of earlier exposures is that of one in {}: motion and light that "
                  "varies meanwhile "
                  "make this wrong by up to {:.2g} e- of a target's flux, and {:.2g} ppm rms",
                  block, error().bias, 1e6 * error().rms));
}

std::int64_t kept_images(const Plan& plan, const Scene& scene) {
  if (!plan.runs("persistence")) return 0;
  if (plan.knobs.memory_block == 0) return 1;
  return persistence_kernel(scene.mission()).reach() / plan.knobs.memory_block + 1;
}

void plan_bands(const Scene& scene, Plan& plan) {
  if (!plan.runs("rolling-shutter")) return;
  const CcdSettings& ccd = scene.mission().ccd;
  plan.knobs.band_rows = plan_band_rows(scene.summary());
  const RowTiming left(scene.summary(), 0.5 * (plan.knobs.band_rows - 1) * scene.mission().cmos.line_time);
  plan.approximations.push_back(fmt::format(
      "{} rows are exposed at the time of their middle row, {} bands in all: this changes fluxes by up to {:.2g} ppm "
      "rms "
      "and {:.2g} e-",
      plan.knobs.band_rows, (ccd.rows + plan.knobs.band_rows - 1) / plan.knobs.band_rows, 1e6 * left.rms, left.bias));
}

}  // namespace astroid
