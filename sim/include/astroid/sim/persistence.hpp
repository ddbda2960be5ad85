// Persistence: charge that traps take from an exposure and release in those that follow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/mission.hpp"

namespace astroid {

/// What traps keep of the charge of an exposure, and what each later one gets of it.
///
/// At the end of an exposure kind i of trap has taken the share f_i of the charge that the pixel then held, what was
/// released into it included; it loses it exponentially with its time constant. What is released between exposures is
/// lost with the reset. Traps are empty at the start of the run. Electrons are taken and released independently, so
/// that Poisson charge splits into Poisson charges that are independent of each other: the expectations are all there
/// is.
/// @source F115; Smith2008
class PersistenceKernel {
 public:
  /// @param left_out  share of the charge of an exposure that may be neglected because it is released too late.
  PersistenceKernel(const PersistenceSettings& settings, Seconds cycle, Seconds exposure, double left_out);

  /// Share of its charge that an exposure does not show.
  [[nodiscard]] double taken() const { return taken_; }
  /// Exposures after which no more is released.
  [[nodiscard]] std::int64_t reach() const { return static_cast<std::int64_t>(released_.size()) - 1; }
  /// Share of the charge of an exposure that the next `n` of them get together.
  [[nodiscard]] double released_within(std::int64_t n) const;

 private:
  double taken_ = 0.0;
  std::vector<double> released_;  // [n], from 0 at n = 0
};

/// The exposure that stands for another one, and what all that it stands for release now.
struct PastCharge {
  std::int64_t exposure = 0;
  double share = 0.0;
};

/// What earlier exposures release in an exposure, the latest first.
/// @param block    exposures that the first of them stands for; 0: the first of the run for all.
/// @param quarter  exposures of a quarter, in which a block ends; 0: there are none.
std::vector<PastCharge> past_charge(const PersistenceKernel& kernel, std::int64_t exposure, std::int64_t block,
                                    double quarter);

/// What is released in an exposure: adds `share` of the electrons of an earlier one.
void add_released(std::span<const float> past, double share, std::span<double> electrons);

/// What an exposure does not show: takes `share` of the electrons of each pixel, of no more than the full well.
void take_trapped(double share, Electrons full_well, std::span<double> electrons);

}  // namespace astroid
