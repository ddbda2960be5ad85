#include "astroid/sim/blooming.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/plane_kernels.hpp"

namespace astroid {

namespace {

/// Fills free room with the charge carried past it. @returns what is carried on
double pour(double& pixel, double full_well, double carried) {
  if (carried <= 0.0 || pixel >= full_well) return carried;
  const double taken = std::min(full_well - pixel, carried);
  pixel = taken == carried ? pixel + carried : full_well;
  return carried - taken;
}

/// Columns that hold any charge at or above the full well, found row by row as the memory lies.
std::vector<int> full_columns(const ImageView<double, unit::SampledElectrons>& electrons, double full_well) {
  const Rectangle& area = electrons.area();
  std::vector<char> full;
  for (int y = area.y0; y < area.y1(); ++y) {
    const std::span<double> row = electrons.row(y);
    if (!any_at_least(row, full_well)) continue;
    full.resize(row.size(), 0);
    for (std::size_t i = 0; i < row.size(); ++i) full[i] |= static_cast<char>(row[i] >= full_well);
  }
  std::vector<int> columns;
  for (std::size_t i = 0; i < full.size(); ++i)
    if (full[i] != 0) columns.push_back(area.x0 + static_cast<int>(i));
  return columns;
}

}  // namespace

double bloom(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
             const ImageView<std::uint8_t, unit::Flags>* flags) {
  const Rectangle& area = electrons.area();
  const auto height = static_cast<std::size_t>(area.ny);
  double lost = 0.0;
  // A column is worked on in a copy: in the image its pixels lie far apart.
  std::vector<double> column(height);
  std::vector<double> half_excess(height);
  std::vector<char> touched(height);
  for (const int x : full_columns(electrons, full_well)) {
    for (std::size_t i = 0; i < height; ++i) {
      const double pixel = electrons.at(x, area.y0 + static_cast<int>(i));
      const double excess = std::max(0.0, pixel - full_well);
      touched[i] = static_cast<char>(pixel >= full_well);
      half_excess[i] = 0.5 * excess;
      column[i] = excess > 0.0 ? full_well : pixel;
    }
    double up = 0.0;
    for (std::size_t i = 0; i < height; ++i) {
      touched[i] |= static_cast<char>(up > 0.0);
      up = pour(column[i], full_well, up) + half_excess[i];
    }
    double down = 0.0;
    for (std::size_t i = height; i-- > 0;) {
      touched[i] |= static_cast<char>(down > 0.0);
      down = pour(column[i], full_well, down) + half_excess[i];
    }
    lost += up + down;
    for (std::size_t i = 0; i < height; ++i) {
      if (touched[i] == 0) continue;
      const int y = area.y0 + static_cast<int>(i);
      electrons.at(x, y) = column[i];
      if (flags != nullptr) flags->at(x, y) |= pixel_flag::kFullWell;
    }
  }
  return lost;
}

double clip_full_well(const ImageView<double, unit::SampledElectrons>& electrons, double full_well,
                      const ImageView<std::uint8_t, unit::Flags>* flags) {
  double removed = 0.0;
  for (int y = electrons.area().y0; y < electrons.area().y1(); ++y) {
    const std::span<double> row = electrons.row(y);
    if (!any_at_least(row, full_well)) continue;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i] < full_well) continue;
      removed += row[i] - full_well;
      row[i] = full_well;
      if (flags != nullptr) flags->row(y)[i] |= pixel_flag::kFullWell;
    }
  }
  return removed;
}

}  // namespace astroid
