// The scenes that the benchmarks of the chain share.
#pragma once

#include <cstdint>
#include <memory>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/sim/plan.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid::bench {

/// A scene and its plan.
struct PlannedScene {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};
PlannedScene plan_scene(const Mission& mission, const StarCatalogue& catalogue);

/// What else than stars, jitter, sky, photon noise, readout noise and ADC a scene has.
enum class Detector : std::uint8_t {
  kReference,  ///< nothing
  kEverything  ///< dark current with DSNU, PRNU, full well with blooming, bias
};

/// The reference exposure: square, in memory, 21 s; Gaussian PSF of 0.65 px, jitter of 0.04 arcsec at 15 arcsec/px,
/// sky 60 e-, readout noise 25 e-, 25 e-/ADU, 16 bits. @param side  px
Mission reference_mission(int side, Detector detector);

/// Stars anywhere on a square of `side` px, magnitudes 8 to 15 with counts that grow as 10^(0.25 m).
StarCatalogue reference_stars(std::uint32_t stars, int side);

inline constexpr int kReferenceSide = 1024;  ///< px
inline constexpr std::uint32_t kReferenceStars = 5000;

/// The preset plato-week, cut short: 32,240 stars on 480 x 480 px, photometry of each.
inline constexpr std::int64_t kWeekExposures = 24192;
Mission week_mission(std::int64_t exposures);
StarCatalogue week_stars(const Mission& mission);

/// CPU seconds of this thread, or of all threads of the process.
double thread_cpu_seconds();
double process_cpu_seconds();

}  // namespace astroid::bench
