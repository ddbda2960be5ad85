#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/distributions.hpp"
#include "astroid/core/jitter_noise.hpp"
#include "astroid/core/math.hpp"
#include "astroid/sim/attitude.hpp"

namespace astroid {

namespace {

constexpr int kMaxSteps = 1000;
enum Axis : std::uint32_t { kYaw = 0, kPitch = 1, kRoll = 2 };

/// exp(-dt/tau) and the rms of what is new after dt.
struct Transition {
  double keep;
  double fresh;
};

Transition transition(double dt, double timescale) {
  const double exponent = -dt / timescale;
  return {det::exp(exponent), det::sqrt(-det::expm1(2.0 * exponent))};
}

class RedNoiseAttitude final : public AttitudeModel {
 public:
  RedNoiseAttitude(const JitterSettings& jitter, const SimulationSettings& simulation, const RandomStream& stream)
      : yaw_(jitter.yaw.value()),
        pitch_(jitter.pitch.value()),
        roll_(jitter.roll.value()),
        timescale_(jitter.timescale.value()),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()),
        stream_(stream) {}

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps));
    const double step = exposure_ / steps;
    const Transition within = transition(step, timescale_);
    const Transition between = transition(cycle_ - exposure_ + step, timescale_);
    Attitude state;
    std::uint64_t number = 0;  // of the step, the address of its draws
    for (std::int64_t exposure = 0; exposure < count; ++exposure) {
      for (std::size_t i = 0; i < attitude.size(); ++i, ++number) {
        const Transition& t = number == 0 ? kStationary : (i == 0 ? between : within);
        state.yaw = t.keep * state.yaw + t.fresh * normal_at_step(stream_, {.step = number, .axis = kYaw});
        state.pitch = t.keep * state.pitch + t.fresh * normal_at_step(stream_, {.step = number, .axis = kPitch});
        state.roll = t.keep * state.roll + t.fresh * normal_at_step(stream_, {.step = number, .axis = kRoll});
        attitude[i] = {yaw_ * state.yaw, pitch_ * state.pitch, roll_ * state.roll};
      }
      visit(attitude);
    }
  }

  [[nodiscard]] AttitudeVariance variance() const override { return scaled(1.0); }

  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    const double rms = ou_mean_rms(1.0, Seconds(timescale_), {Seconds(cycle_), Seconds(exposure_), exposures});
    return scaled(rms * rms);
  }

  [[nodiscard]] int steps_for(double fraction) const override {
    // rms error of the mean over T from midpoints dt apart: s dt / sqrt(6 tau T) for dt << tau. From the
    // covariance of @source F29
    const double by_error = fraction * det::sqrt(6.0 * timescale_ * exposure_);
    const double longest = std::min(by_error, 0.5 * timescale_);
    if (!(longest > 0.0)) return kMaxSteps;
    return static_cast<int>(std::clamp(std::ceil(exposure_ / longest), 1.0, static_cast<double>(kMaxSteps)));
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("Ornstein-Uhlenbeck jitter, rms {}/{}/{} arcsec in yaw/pitch/roll, timescale {} s", yaw_, pitch_,
                       roll_, timescale_);
  }

 private:
  static constexpr Transition kStationary{0.0, 1.0};

  [[nodiscard]] AttitudeVariance scaled(double factor) const {
    return {yaw_ * yaw_ * factor, pitch_ * pitch_ * factor, roll_ * roll_ * factor};
  }

  double yaw_, pitch_, roll_;
  double timescale_, cycle_, exposure_;
  RandomStream stream_;
};

}  // namespace

std::shared_ptr<const AttitudeModel> make_red_noise_attitude(const JitterSettings& jitter,
                                                             const SimulationSettings& simulation,
                                                             const RandomStream& stream) {
  return std::make_shared<const RedNoiseAttitude>(jitter, simulation, stream);
}

}  // namespace astroid
