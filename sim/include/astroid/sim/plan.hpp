// The plan: what will be computed, decided before any pixel is made, and explained.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "astroid/sim/attitude_polynomial.hpp"
#include "astroid/sim/cost_factors.hpp"
#include "astroid/sim/effect.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

/// How the motion within and between exposures enters the image.
enum class JitterTreatment : std::uint8_t {
  kNone,        ///< nothing moves
  kShift,       ///< stars at their mean position of the exposure
  kBroadened,   ///< the same, and the PSF broadened by the motion about it
  kSubSteps,    ///< the mean of the images at every step of the exposure
  kPolynomial,  ///< the same mean, of an image that is a polynomial in attitude and time: a sum of fixed maps
};
std::string_view to_string(JitterTreatment treatment);

/// Stamp size of the stars down to a magnitude.
struct StampTier {
  double min_electrons = 0.0;  ///< stars with at least this many belong to the tier (unless a brighter one takes them)
  double half_width = 0.0;     ///< px
  std::size_t stars = 0;
};

/// What the renderer and the effects take from the plan.
struct PlanKnobs {
  JitterTreatment jitter = JitterTreatment::kNone;
  int attitude_steps = 1;         ///< per exposure
  AttitudePolynomial polynomial;  ///< no terms unless the treatment is kPolynomial
  std::vector<StampTier> stamps;  ///< brightest first
  bool variables = false;         ///< whether variable stars are rendered apart from the others
  int band_rows = 0;              ///< rows that are taken to be exposed at once, with a rolling shutter; 0: all
  /// Exposures whose charge is taken to be that of the first of them, where it is released later; 0: all of the run.
  std::int64_t memory_block = 0;
  [[nodiscard]] double stamp_half_width(double electrons) const;
};

struct PlannedEffect {
  const Effect* effect = nullptr;
  EffectNeed need;
  double seconds = 0.0;  ///< predicted per exposure on one core; 0 when it is off or cached
};

/// The immutable plan of a scene.
struct Plan {
  std::vector<PlannedEffect> effects;  ///< every effect of the table, on or off
  PlanKnobs knobs;
  std::string renderer;  ///< analytic, prf or subpixel
  std::string renderer_reason;
  double renderer_error = 0.0;  ///< of a star's flux, relative
  std::string pixels;           ///< full frame, sub-field or windows, and what is exact
  std::shared_ptr<const PixelLayout>
      layout;          ///< the computed pixels: exposed region r holds the scene's region r, or one all of them
  bool still = false;  ///< exposures share a noiseless image
  std::int64_t epoch_exposures = 0;  ///< exposures that share the slow conditions; 0: all of them
  int reads = 1;                     ///< non-destructive reads of an exposure
  double stamp_error = 0.0;          ///< bound of the error by truncation, e- per exposure on any target
  double jitter_error = 0.0;
  double psf_error = 0.0;
  double tolerance = 0.0;             ///< the tightest of any target, e- per exposure
  double seconds_per_exposure = 0.0;  ///< predicted, one core
  double memory_bytes = 0.0;          ///< predicted, per worker
  std::vector<std::string> approximations;

  [[nodiscard]] bool runs(std::string_view effect) const;
  /// Number of the epoch that an exposure belongs to.
  [[nodiscard]] std::int64_t epoch(std::int64_t exposure) const {
    return epoch_exposures > 0 ? exposure / epoch_exposures : 0;
  }
  /// Where in its epoch an exposure lies, -1 … 1 over it: of its middle, as the conditions and the image take it. 0
  /// where all exposures of an epoch share them.
  [[nodiscard]] double place_in_epoch(std::int64_t exposure) const;
};

/// What the effects that run make of the conditions in an epoch.  @param place  -1 … 1 over it
Conditions conditions_of(const Plan& plan, const Scene& scene, std::int64_t epoch, double place = 0.0);

/// Decides everything from the scene and the accuracy asked for.
/// @param costs                 of this machine, for the predicted times.
/// @param least_attitude_steps  in an exposure. Cameras that share a random path of the attitude must all have the
/// same.
Plan make_plan(const Scene& scene, const CostFactors& costs = {}, int least_attitude_steps = 1);

/// What of CostFactors an effect's time belongs to: its name, or how the plan makes the noiseless image.
std::string cost_part(const PlannedEffect& effect, const Plan& plan);

/// The plan as an explanation to a colleague (plan.txt) and as data (plan.json).
std::string to_text(const Plan& plan, const Scene& scene);
std::string to_json(const Plan& plan, const Scene& scene);

}  // namespace astroid
