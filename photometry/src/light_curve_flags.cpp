#include <algorithm>
#include <tuple>

#include "astroid/photometry/light_curves.hpp"

namespace astroid {

void join_flags(std::vector<LightCurveFlag>& flags) {
  std::sort(flags.begin(), flags.end(), [](const LightCurveFlag& a, const LightCurveFlag& b) {
    return std::tie(a.camera, a.star, a.exposure) < std::tie(b.camera, b.star, b.exposure);
  });
  std::size_t joined = 0;
  for (const LightCurveFlag& next : flags) {
    LightCurveFlag* last = joined > 0 ? &flags[joined - 1] : nullptr;
    const bool follows = last != nullptr && last->camera == next.camera && last->star == next.star &&
                         last->flags == next.flags && last->exposure + last->exposures == next.exposure;
    if (follows)
      last->exposures += next.exposures;
    else
      flags[joined++] = next;
  }
  flags.resize(joined);
}

}  // namespace astroid
