// Maps over the focal plane: tables and figures.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "astroid/analysis/focal_plane.hpp"
#include "astroid/core/image.hpp"

namespace astroid {

/// What the maps are made of.
struct FocalPlaneInput {
  Rectangle detector;
  std::span<const SubFieldMetrics> sub_fields;
  double reference_magnitude = 0.0;
  std::string passband;
  double bin_hours = 1.0;
  int cameras = 1;
  int threads = 0;
};

/// Writes analysis/focal_plane.csv (the sub-fields), analysis/focal_plane_map.csv (surfaces through them) and
/// report/figures/focal_plane_*.
/// @returns what could not be drawn. @throws EnvironmentError(path, cause)
std::vector<std::string> write_focal_plane(const std::filesystem::path& folder, const FocalPlaneInput& input);

}  // namespace astroid
