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

/// By displacements in two cameras whose exposures begin `lag` apart.
CrossMotion shared_motion(const Mission& mission, const std::array<Displacement, 3>& a,
                          const std::array<Displacement, 3>& b, Seconds lag) {
  CrossCovariance total;
  for (std::size_t axis = 0; axis < a.size(); ++axis) {
    total.xx += a[axis].dx * b[axis].dx;
    total.xy += a[axis].dx * b[axis].dy;
    total.yx += a[axis].dy * b[axis].dx;
    total.yy += a[axis].dy * b[axis].dy;
  }
  const SimulationSettings& simulation = mission.simulation;
  const auto of_mean = [&](long exposures) {
    const double kept = ou_mean_covariance(mission.satellite.jitter.timescale,
                                           {simulation.cycle, simulation.exposure_time, exposures}, lag);
    return CrossCovariance{total.xx * kept, total.xy * kept, total.yx * kept, total.yy * kept};
  };
  return {.exposure = of_mean(1), .bin = of_mean(std::lround(mission.analysis.bin / simulation.cycle))};
}

}  // namespace

StarMotion own_motion(const CrossMotion& m) {
  return {.exposure = {m.exposure.xx, m.exposure.xy, m.exposure.yy}, .bin = {m.bin.xx, m.bin.xy, m.bin.yy}};
}

StarMotion star_motion(const Mission& mission, double offset_x, double offset_y) {
  if (mission.satellite.jitter.model != JitterModel::kRedNoise) return {};
  const auto displacements = rms_displacements(mission, offset_x, offset_y);
  return own_motion(shared_motion(mission, displacements, displacements, Seconds(0.0)));
}

CrossMotion cross_motion(const Mission& a, const Mission& b) {
  if (a.satellite.jitter.model != JitterModel::kRedNoise) return {};
  return shared_motion(a, rms_displacements(a, 0.0, 0.0), rms_displacements(b, 0.0, 0.0),
                       b.simulation.stagger - a.simulation.stagger);
}

MotionCovariance motion_like_pixel_noise(const MotionCovariance& bin, double exposures_per_bin, int cameras) {
  const double averaged = exposures_per_bin * cameras;
  return {bin.sxx * averaged, bin.sxy * averaged, bin.syy * averaged};
}

}  // namespace astroid
