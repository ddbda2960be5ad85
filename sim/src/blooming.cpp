#include "astroid/sim/blooming.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace astroid {

namespace {

/// Fills free room with the charge carried past it. @returns what is carried on
double pour(double& pixel, double full_well, double carried) {
  if (carried <= 0.0 || pixel >= full_well) return carried;
  const double taken = std::min(full_well - pixel, carried);
  pixel = taken == carried ? pixel + carried : full_well;
  return carried - taken;
}

}  // namespace

double bloom(const ImageView<double, unit::SampledElectrons>& electrons, double full_well) {
  const Rectangle& area = electrons.area();
  double lost = 0.0;
  std::vector<double> half_excess(static_cast<std::size_t>(area.ny));
  for (int x = area.x0; x < area.x1(); ++x) {
    bool any = false;
    for (int y = area.y0; y < area.y1(); ++y) {
      double& pixel = electrons.at(x, y);
      const double excess = std::max(0.0, pixel - full_well);
      half_excess[static_cast<std::size_t>(y - area.y0)] = 0.5 * excess;
      if (excess > 0.0) {
        pixel = full_well;
        any = true;
      }
    }
    if (!any) continue;
    double up = 0.0;
    for (int y = area.y0; y < area.y1(); ++y) {
      up = pour(electrons.at(x, y), full_well, up);
      up += half_excess[static_cast<std::size_t>(y - area.y0)];
    }
    double down = 0.0;
    for (int y = area.y1() - 1; y >= area.y0; --y) {
      down = pour(electrons.at(x, y), full_well, down);
      down += half_excess[static_cast<std::size_t>(y - area.y0)];
    }
    lost += up + down;
  }
  return lost;
}

double clip_full_well(const ImageView<double, unit::SampledElectrons>& electrons, double full_well) {
  double removed = 0.0;
  for (int y = electrons.area().y0; y < electrons.area().y1(); ++y) {
    for (double& pixel : electrons.row(y)) {
      if (pixel <= full_well) continue;
      removed += pixel - full_well;
      pixel = full_well;
    }
  }
  return removed;
}

}  // namespace astroid
