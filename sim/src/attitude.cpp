#include "astroid/sim/attitude.hpp"

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
