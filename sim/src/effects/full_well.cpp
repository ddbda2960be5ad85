#include "effects/full_well.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "astroid/core/math.hpp"
#include "astroid/sim/blooming.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {
/// A pixel of the noisiest exposure of a run stays below its expectation plus this many standard deviations.
constexpr double kSigmas = 10.0;
}  // namespace

EffectNeed FullWell::is_needed(const SceneSummary& scene) const {
  const double highest = scene.peak_pixel_bound + kSigmas * det::sqrt(scene.peak_pixel_bound);
  const double full_well = scene.mission->ccd.full_well.value();
  const bool needed = highest > full_well;
  return {needed,
          fmt::format(
              "the brightest pixel holds at most {:.4g} e- ({} sigma above its expectation), the full well {:.4g} e-",
              highest, kSigmas, full_well),
          std::max(0.0, highest - full_well), needed ? 1.0 : 0.0};
}

void FullWell::support(const Scene& /*scene*/, std::vector<Rectangle>& /*regions*/) const {}

void FullWell::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  const CcdSettings& ccd = context.scene.mission().ccd;
  const double full_well = ccd.full_well.value();
  for (std::size_t r = 0; r < strip.areas.size(); ++r) {
    const auto electrons = state.sampled.view(strip, r);
    const auto flags = state.computed().flags.view(r);
    state.lost_electrons +=
        ccd.blooming ? bloom(electrons, full_well, &flags) : clip_full_well(electrons, full_well, &flags);
  }
}

}  // namespace astroid
