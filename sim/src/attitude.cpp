#include "astroid/sim/attitude.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace astroid {

std::vector<Attitude> AttitudeModel::sample(std::int64_t count, int steps) const {
  std::vector<Attitude> all;
  all.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(steps));
  for_each_exposure(count, steps, [&all](std::span<const Attitude> exposure) {
    all.insert(all.end(), exposure.begin(), exposure.end());
  });
  return all;
}

AttitudeMoments attitude_moments(std::span<const Attitude> attitude) {
  AttitudeMoments moments;
  const auto n = static_cast<double>(attitude.size());
  for (const Attitude& a : attitude) {
    moments.mean.yaw += a.yaw;
    moments.mean.pitch += a.pitch;
    moments.mean.roll += a.roll;
  }
  moments.mean = {moments.mean.yaw / n, moments.mean.pitch / n, moments.mean.roll / n};
  for (const Attitude& a : attitude) {
    const Attitude d{a.yaw - moments.mean.yaw, a.pitch - moments.mean.pitch, a.roll - moments.mean.roll};
    moments.covariance.yaw_yaw += d.yaw * d.yaw / n;
    moments.covariance.yaw_pitch += d.yaw * d.pitch / n;
    moments.covariance.yaw_roll += d.yaw * d.roll / n;
    moments.covariance.pitch_pitch += d.pitch * d.pitch / n;
    moments.covariance.pitch_roll += d.pitch * d.roll / n;
    moments.covariance.roll_roll += d.roll * d.roll / n;
  }
  return moments;
}

void for_each_exposure_at(const AttitudeModel& gapless, const SimulationSettings& simulation,
                          std::span<const Seconds> offsets, std::int64_t count, int steps,
                          const std::function<void(std::span<const Attitude>)>& visit) {
  const double cycle = simulation.cycle.value();
  const double exposure = simulation.exposure_time.value();
  const int parts = std::max(1, static_cast<int>(std::ceil(steps * cycle / exposure)));
  // Of each attitude of an exposure, its part of this cycle and the next.
  std::vector<std::size_t> at;
  for (const Seconds& offset : offsets)
    for (int i = 0; i < steps; ++i) {
      const double time = offset.value() + (i + 0.5) * exposure / steps;
      const double part = std::clamp(std::floor(time / cycle * parts), 0.0, 2.0 * parts - 1.0);
      at.push_back(static_cast<std::size_t>(part));
    }
  std::vector<Attitude> two_cycles;
  std::vector<Attitude> windows(at.size());
  gapless.for_each_exposure(count + 1, parts, [&](std::span<const Attitude> next) {
    two_cycles.insert(two_cycles.end(), next.begin(), next.end());
    if (two_cycles.size() == next.size()) return;
    for (std::size_t i = 0; i < at.size(); ++i) windows[i] = two_cycles[at[i]];
    visit(windows);
    two_cycles.erase(two_cycles.begin(), two_cycles.begin() + parts);
  });
}

namespace {

class StillAttitude final : public AttitudeModel {
 public:
  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    const std::vector<Attitude> still(static_cast<std::size_t>(steps));
    for (std::int64_t exposure = 0; exposure < count; ++exposure) visit(still);
  }
  [[nodiscard]] AttitudeVariance variance() const override { return {}; }
  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t /*exposures*/) const override { return {}; }
  [[nodiscard]] AttitudeVariance covariance_of_mean(std::int64_t /*exposures*/, Seconds /*lag*/) const override {
    return {};
  }
  [[nodiscard]] int steps_for(double /*fraction*/) const override { return 1; }
  [[nodiscard]] std::string description() const override { return "the spacecraft does not move"; }
};

}  // namespace

std::shared_ptr<const AttitudeModel> make_still_attitude() {
  return std::make_shared<const StillAttitude>();
}

}  // namespace astroid
