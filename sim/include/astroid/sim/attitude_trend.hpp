// The part of the attitude that is no noise: thermo-elastic drift, and the error of each re-pointing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "astroid/core/mission.hpp"
#include "astroid/core/random.hpp"
#include "astroid/sim/attitude.hpp"

namespace astroid {

/// A second-order polynomial of time in each quarter, which begins anew when the spacecraft is pointed again. An
/// exposure belongs to the quarter in which it begins. Immutable.
class AttitudeTrend {
 public:
  /// Nothing moves.
  AttitudeTrend() = default;

  /// Deviation at a time. @param time  s since the start of the run.  @param start  of the exposure it belongs to
  [[nodiscard]] Attitude at(double time, double start) const;
  /// The largest deviation of each axis over the run, in absolute value, arcsec.
  [[nodiscard]] const Attitude& farthest() const { return farthest_; }
  /// The largest rate of each axis over the run, in absolute value, arcsec/s.
  [[nodiscard]] const Attitude& fastest() const { return fastest_; }
  [[nodiscard]] bool is_still() const { return quarters_.empty(); }

  friend AttitudeTrend thermo_elastic_drift(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                                            const RandomStream& stream);
  friend AttitudeTrend repointing_error(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                                        const RandomStream& stream);
  friend AttitudeTrend operator+(const AttitudeTrend& a, const AttitudeTrend& b);

 private:
  /// arcsec, arcsec/s and arcsec/s², of yaw, pitch and roll, from the beginning of the quarter.
  struct Quadratic {
    double constant = 0.0, linear = 0.0, quadratic = 0.0;
  };
  using Quarter = std::array<Quadratic, 3>;
  AttitudeTrend(std::vector<Quarter> quarters, double length, double end);
  [[nodiscard]] std::size_t quarter_of(double start) const;

  std::vector<Quarter> quarters_;
  double length_ = 0.0;  // of a quarter, s
  double end_ = 0.0;     // of the run, s
  Attitude farthest_, fastest_;
};

/// The drift of each quarter: the linear rate of the configuration, and a thermo-elastic part of each axis,
/// A s (0.972 b t/Q - 0.504 a (t/Q)²) arcsec with A its amplitude, Q the length of a quarter, t the time since it
/// began, a and b uniform in 0 .. 1 and the sign s drawn for each quarter and axis: it starts at 0, stays within A, and
/// as a rule turns back. @source Jannsen2024
AttitudeTrend thermo_elastic_drift(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                                   const RandomStream& stream);

/// The normal error of the pointing of each quarter but the first, which is where the configuration says.
AttitudeTrend repointing_error(const SatelliteSettings& satellite, const SimulationSettings& simulation,
                               const RandomStream& stream);

/// Both. They must be of the same run.
AttitudeTrend operator+(const AttitudeTrend& a, const AttitudeTrend& b);

/// Noise about a trend. variance(), variance_of_mean() and covariance_of_mean() are those of the noise.
std::shared_ptr<const AttitudeModel> make_drifting_attitude(std::shared_ptr<const AttitudeModel> noise,
                                                            AttitudeTrend trend, const SimulationSettings& simulation);

}  // namespace astroid
