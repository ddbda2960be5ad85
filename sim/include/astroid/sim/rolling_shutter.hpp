// Rolling shutter: what it matters that rows are exposed one after the other.
#pragma once

#include <vector>

#include "astroid/core/mission.hpp"
#include "astroid/sim/scene_summary.hpp"

namespace astroid {

/// How much fluxes change where stars are exposed at another time than they are taken to be.
///
/// The mean of stationary motion of rms s over windows of length T that begin d apart differs by at most √2 s d/T rms,
/// and by √2 s. Drift moves stars by its largest rate times d.
/// @source F116
struct RowTiming {
  RowTiming(const SceneSummary& scene, Seconds delay);
  double rms = 0.0;             ///< of the brightest target's flux in an exposure, relative, both axes
  double variance_ratio = 0.0;  ///< of the same to what noise leaves in the longest bin reported
  double bias = 0.0;            ///< e- per exposure, by drift
};

/// Rows that may share the time of their middle row: as many as change no flux by more than a tenth of its tolerance;
/// no fewer than make 256 bands.
int plan_band_rows(const SceneSummary& scene);

/// When the bands of a detector are exposed, relative to its first row.
std::vector<Seconds> band_times(const Mission& mission, int band_rows);

}  // namespace astroid
