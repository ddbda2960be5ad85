#include "astroid/analysis/motion.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "astroid/core/camera_groups.hpp"
#include "astroid/core/jitter_noise.hpp"
#include "astroid/core/sphere.hpp"

namespace astroid {

namespace {

/// px, by the rms of an angle of the spacecraft.
struct Displacement {
  double dx = 0.0, dy = 0.0;
};

/// Of a star so far from the axis of a mission's camera, px: by the rms of yaw, pitch and roll.
std::array<Displacement, 3> rms_displacements(const Mission& mission, double offset_x, double offset_y) {
  const JitterSettings& jitter = mission.satellite.jitter;
  const Boresight from = spacecraft_boresight(mission);
  const Boresight to = camera_boresight(mission);
  const bool is_turned = to.axis.ra != from.axis.ra || to.axis.dec != from.axis.dec || to.roll != from.roll;
  const CameraAxes craft = camera_axes(from);
  const CameraAxes camera = camera_axes(to);
  // A turn from u to v, seen as turns of the camera: from its axis to x, from its axis to y, and from x to y.
  const auto turned = [&](const Direction& u, const Direction& v, Arcseconds rms) {
    const auto part = [&](const Direction& a, const Direction& b) {
      return dot(u, a) * dot(v, b) - dot(v, a) * dot(u, b);
    };
    const double px = (rms / mission.ccd.pixel_scale).value();
    const double roll = to_radians(rms).value() * part(camera.x, camera.y);
    return Displacement{px * part(camera.axis, camera.x) - roll * offset_y,
                        px * part(camera.axis, camera.y) + roll * offset_x};
  };
  if (is_turned)
    return {turned(craft.axis, craft.x, jitter.yaw), turned(craft.axis, craft.y, jitter.pitch),
            turned(craft.x, craft.y, jitter.roll)};
  const double roll = to_radians(jitter.roll).value();
  return {Displacement{(jitter.yaw / mission.ccd.pixel_scale).value(), 0.0},
          Displacement{0.0, (jitter.pitch / mission.ccd.pixel_scale).value()},
          Displacement{-roll * offset_y, roll * offset_x}};
}

}  // namespace

StarMotion star_motion(const Mission& mission, double offset_x, double offset_y) {
  const JitterSettings& jitter = mission.satellite.jitter;
  if (jitter.model != JitterModel::kRedNoise) return {};
  MotionCovariance total;
  for (const Displacement& d : rms_displacements(mission, offset_x, offset_y)) {
    total.sxx += d.dx * d.dx;
    total.sxy += d.dx * d.dy;
    total.syy += d.dy * d.dy;
  }

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

CrossMotion cross_motion(const Mission& a, const Mission& b) {
  const JitterSettings& jitter = a.satellite.jitter;
  if (jitter.model != JitterModel::kRedNoise) return {};
  const auto in_a = rms_displacements(a, 0.0, 0.0);
  const auto in_b = rms_displacements(b, 0.0, 0.0);
  const SimulationSettings& simulation = a.simulation;
  const auto shared = [&](long exposures) {
    const double kept = ou_mean_covariance(jitter.timescale, {simulation.cycle, simulation.exposure_time, exposures},
                                           b.simulation.stagger - simulation.stagger);
    CrossCovariance c;
    for (std::size_t axis = 0; axis < in_a.size(); ++axis) {
      c.xx += in_a[axis].dx * in_b[axis].dx;
      c.xy += in_a[axis].dx * in_b[axis].dy;
      c.yx += in_a[axis].dy * in_b[axis].dx;
      c.yy += in_a[axis].dy * in_b[axis].dy;
    }
    return CrossCovariance{c.xx * kept, c.xy * kept, c.yx * kept, c.yy * kept};
  };
  return {.exposure = shared(1), .bin = shared(std::lround(a.analysis.bin / simulation.cycle))};
}

MotionCovariance motion_like_pixel_noise(const MotionCovariance& bin, double exposures_per_bin, int cameras) {
  const double averaged = exposures_per_bin * cameras;
  return {bin.sxx * averaged, bin.sxy * averaged, bin.syy * averaged};
}

}  // namespace astroid
