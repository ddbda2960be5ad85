#include "astroid/sim/rolling_shutter.hpp"

#include <algorithm>

#include "astroid/core/math.hpp"

namespace astroid {

RowTiming::RowTiming(const SceneSummary& scene, Seconds delay) {
  const SimulationSettings& simulation = scene.mission->simulation;
  const double part = std::min(1.0, delay / simulation.exposure_time);
  rms = 2.0 * scene.psf.gradient * scene.attitude_rms_px * part;
  const double flux = scene.brightest_target_electrons;
  variance_ratio = flux > 0.0 ? rms * rms / scene.relative_variance_in_bin(flux) : 0.0;
  bias = flux * scene.psf.gradient * scene.drift_px_per_second * delay.value();
}

int plan_band_rows(const SceneSummary& scene) {
  const Mission& mission = *scene.mission;
  const Seconds line = mission.cmos.line_time;
  constexpr double kShare = 0.1;  // of the tolerances
  constexpr int kMostBands = 256;
  int rows = std::max(1, mission.ccd.rows);
  const int fewest = (rows + kMostBands - 1) / kMostBands;
  while (rows > fewest) {
    // The first and last row of a band of R rows are (R - 1) / 2 line times away from its middle.
    const RowTiming timing(scene, 0.5 * static_cast<double>(rows - 1) * line);
    if (timing.variance_ratio <= kShare * kVarianceTolerance && timing.bias <= kShare * scene.tightest_tolerance())
      break;
    rows = std::max(fewest, (rows + 1) / 2);
  }
  return rows;
}

std::vector<Seconds> band_times(const Mission& mission, int band_rows) {
  std::vector<Seconds> times;
  for (int first = 0; first < mission.ccd.rows; first += band_rows) {
    const int last = std::min(first + band_rows, mission.ccd.rows) - 1;
    times.push_back(0.5 * static_cast<double>(first + last) * mission.cmos.line_time);
  }
  return times;
}

}  // namespace astroid
