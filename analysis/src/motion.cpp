#include "astroid/analysis/motion.hpp"

#include <cmath>

#include "astroid/core/jitter_noise.hpp"

namespace astroid {

StarMotion star_motion(const Mission& mission, double offset_x, double offset_y) {
  const JitterSettings& jitter = mission.satellite.jitter;
  if (jitter.model != JitterModel::kRedNoise) return {};
  const double yaw = (jitter.yaw / mission.ccd.pixel_scale).value();
  const double pitch = (jitter.pitch / mission.ccd.pixel_scale).value();
  const double roll = to_radians(jitter.roll).value();
  MotionCovariance total;
  total.sxx = yaw * yaw + roll * roll * offset_y * offset_y;
  total.syy = pitch * pitch + roll * roll * offset_x * offset_x;
  total.sxy = -roll * roll * offset_x * offset_y;

  const SimulationSettings& simulation = mission.simulation;
  const auto kept = [&](long exposures) {  // of the variance, in the mean over so many exposures
    const double rms = ou_mean_rms(1.0, jitter.timescale, {simulation.cycle, simulation.exposure_time, exposures});
    return rms * rms;
  };
  const double exposure = kept(1);
  const double bin = kept(std::lround(mission.analysis.bin / simulation.cycle));
  return {{total.sxx * exposure, total.sxy * exposure, total.syy * exposure},
          {total.sxx * bin, total.sxy * bin, total.syy * bin}};
}

MotionCovariance motion_like_pixel_noise(const MotionCovariance& bin, double exposures_per_bin, int cameras) {
  const double averaged = exposures_per_bin * cameras;
  return {bin.sxx * averaged, bin.sxy * averaged, bin.syy * averaged};
}

}  // namespace astroid
