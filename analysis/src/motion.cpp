#include "astroid/analysis/motion.hpp"

#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {

RetainedVariance red_noise_retained(double timescale, const Cadence& cadence) {
  ASTROID_CHECK_LT(0.0, timescale);
  ASTROID_CHECK_LE(cadence.exposure, cadence.cycle);
  const double t = cadence.exposure / timescale;
  RetainedVariance out;
  // Var of the mean of exp(-|u|) over [0, t]: 2 (t - 1 + e^-t) / t^2; cov of two means at distance k c:
  // (4 sinh^2(t/2) / t^2) e^(-k c). Below kSmall the limits 1 - t/3 and 1 + t^2/12 are good to 1e-10.
  constexpr double kSmall = 1e-5;
  out.exposure = t < kSmall ? 1.0 - t / 3.0 : 2.0 * (t + std::expm1(-t)) / (t * t);
  const double half = t < kSmall ? 1.0 : std::sinh(0.5 * t) / (0.5 * t);
  const double pair = half * half;
  const double n = static_cast<double>(cadence.per_bin);
  double sum = n * out.exposure;
  for (std::int64_t k = 1; k < cadence.per_bin; ++k) {
    sum += 2.0 * (n - static_cast<double>(k)) * pair * std::exp(-static_cast<double>(k) * cadence.cycle / timescale);
  }
  out.bin = sum / (n * n);
  return out;
}

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
  const Cadence cadence{mission.simulation.exposure_time.value(), mission.simulation.cycle.value(),
                        static_cast<std::int64_t>(std::llround(mission.analysis.bin / mission.simulation.cycle))};
  const RetainedVariance kept = red_noise_retained(jitter.timescale.value(), cadence);
  return {{total.sxx * kept.exposure, total.sxy * kept.exposure, total.syy * kept.exposure},
          {total.sxx * kept.bin, total.sxy * kept.bin, total.syy * kept.bin}};
}

}  // namespace astroid
