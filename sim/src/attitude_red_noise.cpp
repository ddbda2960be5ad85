#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
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

/// An instant at which the process is known in every cycle: the midpoint of a step of some cameras' exposure.
struct Instant {
  double place;          // s, since the start of the cycle
  std::size_t stagger;   // number of these cameras' stagger
  int step;              // of their exposure
  std::int64_t earlier;  // cycles ago in which that exposure began
  Transition after{};    // from the instant before
};

class RedNoiseAttitude final : public AttitudeModel {
 public:
  RedNoiseAttitude(const JitterSettings& jitter, const SimulationSettings& simulation, const RandomStream& stream,
                   std::span<const double> staggers)
      : yaw_(jitter.yaw.value()),
        pitch_(jitter.pitch.value()),
        roll_(jitter.roll.value()),
        timescale_(jitter.timescale.value()),
        stagger_(simulation.stagger.value()),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()),
        stream_(stream),
        staggers_(staggers.begin(), staggers.end()) {
    if (staggers_.empty()) staggers_ = {stagger_};
    std::ranges::sort(staggers_);
    staggers_.erase(std::unique(staggers_.begin(), staggers_.end()), staggers_.end());
    ASTROID_CHECK_EQ(std::ranges::binary_search(staggers_, stagger_), true);
  }

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    if (count < 1) return;
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps));
    const std::vector<Instant> instants = instants_of_cycle(steps);
    Attitude state;
    std::uint64_t number = 0;  // of the instant, the address of its draws
    for (std::int64_t cycle = 0;; ++cycle)
      for (const Instant& instant : instants) {
        const Transition& t = number == 0 ? kStationary : instant.after;
        state.yaw = t.keep * state.yaw + t.fresh * normal_at_step(stream_, {.step = number, .axis = kYaw});
        state.pitch = t.keep * state.pitch + t.fresh * normal_at_step(stream_, {.step = number, .axis = kPitch});
        state.roll = t.keep * state.roll + t.fresh * normal_at_step(stream_, {.step = number, .axis = kRoll});
        ++number;
        const std::int64_t exposure = cycle - instant.earlier;
        if (staggers_[instant.stagger] != stagger_ || exposure < 0) continue;
        attitude[static_cast<std::size_t>(instant.step)] = {yaw_ * state.yaw, pitch_ * state.pitch, roll_ * state.roll};
        if (instant.step + 1 < steps) continue;
        visit(attitude);
        if (exposure + 1 == count) return;
      }
  }

  [[nodiscard]] AttitudeVariance variance() const override { return scaled(1.0); }

  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    const double rms = ou_mean_rms(1.0, Seconds(timescale_), {Seconds(cycle_), Seconds(exposure_), exposures});
    return scaled(rms * rms);
  }

  [[nodiscard]] AttitudeVariance covariance_of_mean(std::int64_t exposures, Seconds lag) const override {
    return scaled(ou_mean_covariance(Seconds(timescale_), {Seconds(cycle_), Seconds(exposure_), exposures}, lag));
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

  /// In the order of time.
  [[nodiscard]] std::vector<Instant> instants_of_cycle(int steps) const {
    const double step = exposure_ / steps;
    std::vector<Instant> instants;
    for (std::size_t s = 0; s < staggers_.size(); ++s)
      for (int i = 0; i < steps; ++i) {
        const double offset = staggers_[s] + (i + 0.5) * step;
        const double cycles = std::floor(offset / cycle_);
        instants.push_back(
            {.place = offset - cycles * cycle_, .stagger = s, .step = i, .earlier = static_cast<std::int64_t>(cycles)});
      }
    std::ranges::stable_sort(instants, {}, &Instant::place);
    const Transition within = transition(step, timescale_);
    const Transition between = transition(cycle_ - exposure_ + step, timescale_);
    double before = instants.back().place - cycle_;
    for (Instant& instant : instants) {
      const double gap = std::max(0.0, instant.place - before);
      before = instant.place;
      // The steps of one camera alone are equal, to the bit.
      instant.after = staggers_.size() > 1 ? transition(gap, timescale_) : (instant.step == 0 ? between : within);
    }
    return instants;
  }

  [[nodiscard]] AttitudeVariance scaled(double factor) const {
    return {yaw_ * yaw_ * factor, pitch_ * pitch_ * factor, roll_ * roll_ * factor};
  }

  double yaw_, pitch_, roll_;
  double timescale_, stagger_, cycle_, exposure_;
  RandomStream stream_;
  std::vector<double> staggers_;  // s, of all cameras, rising
};

}  // namespace

std::shared_ptr<const AttitudeModel> make_red_noise_attitude(const JitterSettings& jitter,
                                                             const SimulationSettings& simulation,
                                                             const RandomStream& stream,
                                                             std::span<const double> staggers) {
  return std::make_shared<const RedNoiseAttitude>(jitter, simulation, stream, staggers);
}

}  // namespace astroid
