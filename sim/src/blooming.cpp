#include "astroid/sim/blooming.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"

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

namespace {

/// Columns that have any charge above the full well, found row by row as the memory lies.
std::vector<int> overfull_columns(const ImageView<double, unit::SampledElectrons>& electrons, double full_well) {
  const Rectangle& area = electrons.area();
  std::vector<char> overfull(static_cast<std::size_t>(area.nx), 0);
  for (int y = area.y0; y < area.y1(); ++y) {
    const std::span<double> row = electrons.row(y);
    for (std::size_t i = 0; i < row.size(); ++i) overfull[i] |= static_cast<char>(row[i] > full_well);
  }
  std::vector<int> columns;
  for (std::size_t i = 0; i < overfull.size(); ++i)
    if (overfull[i] != 0) columns.push_back(area.x0 + static_cast<int>(i));
  return columns;
}

}  // namespace

double bloom(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
             const ImageView<std::uint8_t, unit::Flags>* flags) {
  const Rectangle& area = electrons.area();
  double lost = 0.0;
  std::vector<double> half_excess(static_cast<std::size_t>(area.ny));
  for (const int x : overfull_columns(electrons, full_well)) {
    const auto touch = [&](int y, bool touched) {
      if (touched && flags != nullptr) flags->at(x, y) |= pixel_flag::kFullWell;
    };
    for (int y = area.y0; y < area.y1(); ++y) {
      double& pixel = electrons.at(x, y);
      const double excess = std::max(0.0, pixel - full_well);
      half_excess[static_cast<std::size_t>(y - area.y0)] = 0.5 * excess;
      if (excess > 0.0) pixel = full_well;
      touch(y, excess > 0.0);
    }
    double up = 0.0;
    for (int y = area.y0; y < area.y1(); ++y) {
      touch(y, up > 0.0);
      up = pour(electrons.at(x, y), full_well, up);
      up += half_excess[static_cast<std::size_t>(y - area.y0)];
    }
    double down = 0.0;
    for (int y = area.y1() - 1; y >= area.y0; --y) {
      touch(y, down > 0.0);
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
