// Expected light in small apertures, to compare images that were made in different ways.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "astroid/sim/scene.hpp"
#include "astroid/sim/simulator.hpp"

namespace astroid::test {

/// Of each target, in the 3 x 3 px around its nominal place; e-.  @param state  of a full frame
inline std::vector<double> aperture_fluxes(const Scene& scene, const ExposureState& state) {
  std::vector<double> fluxes;
  for (const std::size_t target : scene.targets()) {
    const PixelPosition p = scene.stars()[target].position;
    const Rectangle box =
        intersect({static_cast<int>(std::floor(p.x + 0.5)) - 1, static_cast<int>(std::floor(p.y + 0.5)) - 1, 3, 3},
                  scene.detector());
    double sum = 0.0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x) sum += state.expected.whole().view(0).at(x, y);
    fluxes.push_back(sum);
  }
  return fluxes;
}

}  // namespace astroid::test
