// Noise, contamination and recovery over the whole focal plane, from a few sub-fields of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "astroid/analysis/focal_plane.hpp"
#include "astroid/core/configuration.hpp"
#include "astroid/pipeline/run.hpp"

namespace astroid {

struct FocalPlaneOptions {
  int across = 3, down = 3;         ///< sub-fields along columns and rows
  int side = 200;                   ///< of each, px
  std::optional<double> magnitude;  ///< reference magnitude; without: the median of the targets
  int group = 1;                    ///< of cameras, from 1, of a mission that has several
};

struct FocalPlaneResult {
  double reference_magnitude = 0.0;
  std::vector<SubFieldMetrics> sub_fields;
  std::vector<std::string> warnings;
};

/// Simulates and measures square sub-fields spread evenly over the detector, each with what it has of PSF, distortion,
/// vignetting and charge transfer at its place, and writes the maps through them into a folder of products.
/// @throws InputError when no sub-field has a target, or the mission has no such group.
FocalPlaneResult map_focal_plane(const ResolvedConfiguration& configuration, const RunOptions& options,
                                 const FocalPlaneOptions& maps);

}  // namespace astroid
