#include "astroid/sim/attitude_trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "astroid/catalogues/sky_brightness.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/run_time.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr std::size_t kAxes = 3;
// Of a thermo-elastic polynomial of unit amplitude over a quarter: 1.5e-6 x 90 d / 12 and 1e-13 x (90 d)² / 12.
// @source Jannsen2024
constexpr double kLargestLinear = 0.972;
constexpr double kLargestQuadratic = 0.504;

/// Length of a quarter and how many begin in the run; without re-pointing there is one.
struct Quarters {
  double length;
  std::size_t count;
};
Quarters quarters_of(const SatelliteSettings& satellite, const SimulationSettings& simulation) {
  const double end = end_of_run(simulation).value();
  const double length = satellite.quarter_days * kSecondsPerDay;
  if (!(length > 0.0)) return {end, 1};
  return {length, static_cast<std::size_t>(std::floor(end / length)) + 1};
}

std::array<double, kAxes> axes(const Arcseconds& yaw, const Arcseconds& pitch, const Arcseconds& roll) {
  return {yaw.value(), pitch.value(), roll.value()};
}

bool is_zero(const std::array<double, kAxes>& values) {
  return std::ranges::all_of(values, [](double v) { return v == 0.0; });
}

class DriftingAttitude final : public AttitudeModel {
 public:
  DriftingAttitude(std::shared_ptr<const AttitudeModel> noise, AttitudeTrend trend,
                   const SimulationSettings& simulation)
      : noise_(std::move(noise)),
        trend_(std::move(trend)),
        stagger_(simulation.stagger.value()),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()) {}

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    std::vector<Attitude> sum(static_cast<std::size_t>(steps));
    std::int64_t exposure = 0;
    noise_->for_each_exposure(count, steps, [&](std::span<const Attitude> noise) {
      const double start = stagger_ + static_cast<double>(exposure++) * cycle_;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const Attitude drift = trend_.at(start + (static_cast<double>(i) + 0.5) * exposure_ / steps, start);
        sum[i] = {noise[i].yaw + drift.yaw, noise[i].pitch + drift.pitch, noise[i].roll + drift.roll};
      }
      visit(sum);
    });
  }
  [[nodiscard]] AttitudeVariance variance() const override { return noise_->variance(); }
  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    return noise_->variance_of_mean(exposures);
  }
  [[nodiscard]] AttitudeVariance covariance_of_mean(std::int64_t exposures, Seconds lag) const override {
    return noise_->covariance_of_mean(exposures, lag);
  }
  [[nodiscard]] int steps_for(double fraction) const override {
    // Within an exposure the drift is a straight line: four midpoints have its mean, and its variance to 6 %.
    constexpr int kSteps = 4;
    return std::max(kSteps, noise_->steps_for(fraction));
  }
  [[nodiscard]] std::string description() const override {
    const Attitude& far = trend_.farthest();
    return fmt::format("{}; drift and re-pointing up to {:.3g}/{:.3g}/{:.3g} arcsec in yaw/pitch/roll",
                       noise_->description(), far.yaw, far.pitch, far.roll);
  }

 private:
  std::shared_ptr<const AttitudeModel> noise_;
  AttitudeTrend trend_;
  double stagger_, cycle_, exposure_;
};

}  // namespace

AttitudeTrend::AttitudeTrend(std::vector<Quarter> quarters, double length, double end)
    : quarters_(std::move(quarters)), length_(length), end_(end) {
  std::array<double, kAxes> farthest{};
  std::array<double, kAxes> fastest{};
  for (std::size_t q = 0; q < quarters_.size(); ++q) {
    const double span = std::min(length_, end_ - static_cast<double>(q) * length_);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const Quadratic& c = quarters_[q][axis];
      const auto value = [&c](double t) { return std::fabs(c.constant + t * (c.linear + t * c.quadratic)); };
      const double turn = c.quadratic != 0.0 ? -0.5 * c.linear / c.quadratic : 0.0;
      farthest[axis] = std::max({farthest[axis], value(0.0), value(span), value(std::clamp(turn, 0.0, span))});
      fastest[axis] = std::max({fastest[axis], std::fabs(c.linear), std::fabs(c.linear + 2.0 * span * c.quadratic)});
    }
  }
  farthest_ = {farthest[0], farthest[1], farthest[2]};
  fastest_ = {fastest[0], fastest[1], fastest[2]};
}

std::size_t AttitudeTrend::quarter_of(double start) const {
  const auto quarter = static_cast<std::size_t>(std::max(0.0, std::floor(start / length_)));
  return std::min(quarter, quarters_.size() - 1);
}

Attitude AttitudeTrend::at(double time, double start) const {
  if (quarters_.empty()) return {};
  const std::size_t quarter = quarter_of(start);
  const double t = time - static_cast<double>(quarter) * length_;
  const auto value = [t](const Quadratic& c) { return c.constant + t * (c.linear + t * c.quadratic); };
  const Quarter& q = quarters_[quarter];
  return {value(q[0]), value(q[1]), value(q[2])};
}

AttitudeTrend thermo_elastic_drift(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                                   const RandomStream& stream) {
  const DriftSettings& drift = satellite.drift;
  const auto amplitude = axes(drift.yaw, drift.pitch, drift.roll);
  const auto rate = axes(drift.yaw_rate, drift.pitch_rate, drift.roll_rate);
  if (is_zero(amplitude) && is_zero(rate)) return {};
  const auto [length, count] = quarters_of(satellite, simulation);
  const auto first = static_cast<std::size_t>(simulation.quarter);
  // Without quarters, thermo-elastic motion still has the pace of one.
  constexpr double kUsualQuarter = 90.0 * kSecondsPerDay;
  const double pace = satellite.quarter_days > 0.0 ? length : kUsualQuarter;
  std::vector<AttitudeTrend::Quarter> quarters(count);
  for (std::size_t q = 0; q < count; ++q)
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const auto uniform = [&](std::uint32_t draw) {
        return uniform_at_step(stream, {.step = first + q, .axis = static_cast<std::uint32_t>(axis), .draw = draw});
      };
      const double signed_amplitude = uniform(0) < 0.5 ? -amplitude[axis] : amplitude[axis];
      quarters[q][axis].linear = rate[axis] / kSecondsPerDay + signed_amplitude * kLargestLinear * uniform(1) / pace;
      quarters[q][axis].quadratic = -signed_amplitude * kLargestQuadratic * uniform(2) / (pace * pace);
    }
  return {std::move(quarters), length, end_of_run(simulation).value()};
}

AttitudeTrend repointing_error(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                               const RandomStream& stream) {
  const auto rms = axes(satellite.repointing.yaw, satellite.repointing.pitch, satellite.repointing.roll);
  const auto [length, count] = quarters_of(satellite, simulation);
  const auto first = static_cast<std::size_t>(simulation.quarter);
  if (is_zero(rms) || first + count < 2) return {};
  std::vector<AttitudeTrend::Quarter> quarters(count);
  for (std::size_t q = first > 0 ? 0 : 1; q < count; ++q)
    for (std::size_t axis = 0; axis < kAxes; ++axis)
      quarters[q][axis].constant =
          rms[axis] * normal_at_step(stream, {.step = first + q, .axis = static_cast<std::uint32_t>(axis)});
  return {std::move(quarters), length, end_of_run(simulation).value()};
}

AttitudeTrend operator+(const AttitudeTrend& a, const AttitudeTrend& b) {
  if (a.is_still()) return b;
  if (b.is_still()) return a;
  ASTROID_CHECK_EQ(a.quarters_.size(), b.quarters_.size());
  std::vector<AttitudeTrend::Quarter> sum = a.quarters_;
  for (std::size_t q = 0; q < sum.size(); ++q)
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      sum[q][axis].constant += b.quarters_[q][axis].constant;
      sum[q][axis].linear += b.quarters_[q][axis].linear;
      sum[q][axis].quadratic += b.quarters_[q][axis].quadratic;
    }
  return {std::move(sum), a.length_, a.end_};
}

std::shared_ptr<const AttitudeModel> make_drifting_attitude(std::shared_ptr<const AttitudeModel> noise,
                                                            AttitudeTrend trend, const SimulationSettings& simulation) {
  if (trend.is_still()) return noise;
  return std::make_shared<const DriftingAttitude>(std::move(noise), std::move(trend), simulation);
}

}  // namespace astroid
