#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "astroid/core/math.hpp"
#include "astroid/sim/attitude.hpp"
#include "spectral_noise.hpp"

namespace astroid {

namespace {

constexpr int kMaxSteps = 1000;

class SpectrumAttitude final : public AttitudeModel {
 public:
  SpectrumAttitude(const JitterSpectrum& spectrum, std::string source, const SimulationSettings& simulation,
                   const RandomStream& stream)
      : noise_(spectrum, stream),
        source_(std::move(source)),
        lowest_(spectrum[0].lowest()),
        highest_(spectrum[0].highest()),
        stagger_(simulation.stagger.value()),
        cycle_(simulation.cycle.value()),
        exposure_(simulation.exposure_time.value()) {}

  void for_each_exposure(std::int64_t count, int steps,
                         const std::function<void(std::span<const Attitude>)>& visit) const override {
    std::vector<Attitude> attitude(static_cast<std::size_t>(steps));
    SpectralNoise::Blocks blocks;
    for (std::int64_t exposure = 0; exposure < count; ++exposure) {
      noise_.at(stagger_ + static_cast<double>(exposure) * cycle_, exposure_ / steps, attitude, blocks);
      visit(attitude);
    }
  }

  [[nodiscard]] AttitudeVariance variance() const override { return noise_.variance(); }

  [[nodiscard]] AttitudeVariance variance_of_mean(std::int64_t exposures) const override {
    return noise_.variance_of_mean(exposure_, cycle_, exposures);
  }
  [[nodiscard]] AttitudeVariance covariance_of_mean(std::int64_t exposures, Seconds lag) const override {
    return noise_.covariance_of_mean(exposure_, cycle_, exposures, lag.value());
  }

  [[nodiscard]] int steps_for(double fraction) const override {
    const AttitudeVariance whole = noise_.variance();
    const auto good = [&](int steps) {
      const AttitudeVariance error = noise_.sampling_variance(exposure_, steps);
      const double limit = fraction * fraction;
      return error.yaw <= limit * whole.yaw && error.pitch <= limit * whole.pitch && error.roll <= limit * whole.roll;
    };
    int low = 0;
    int high = 1;
    while (high < kMaxSteps && !good(high)) {
      low = high;
      high = std::min(2 * high, kMaxSteps);
    }
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      (good(middle) ? high : low) = middle;
    }
    return high;
  }

  [[nodiscard]] std::string description() const override {
    const AttitudeVariance v = variance();
    return fmt::format(
        "jitter with the spectrum of {}, {:.3g} to {:.3g} Hz, rms {:.4g}/{:.4g}/{:.4g} arcsec in yaw/pitch/roll",
        source_, lowest_, highest_, det::sqrt(v.yaw), det::sqrt(v.pitch), det::sqrt(v.roll));
  }

 private:
  SpectralNoise noise_;
  std::string source_;
  double lowest_, highest_;
  double stagger_, cycle_, exposure_;
};

}  // namespace

std::shared_ptr<const AttitudeModel> make_spectrum_attitude(const JitterSpectrum& spectrum, const std::string& source,
                                                            const SimulationSettings& simulation,
                                                            const RandomStream& stream) {
  return std::make_shared<const SpectrumAttitude>(spectrum, source, simulation, stream);
}

}  // namespace astroid
