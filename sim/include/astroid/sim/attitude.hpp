// The spacecraft's attitude: shared by all cameras, a pure function of absolute time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/attitude.hpp"
#include "astroid/core/mission.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/sim/jitter_spectrum.hpp"

namespace astroid {

/// Mean of a few attitudes, and their covariance about it.
struct AttitudeMoments {
  Attitude mean;
  AttitudeCovariance covariance;
};
/// @param attitude  not empty; every one counts the same.
AttitudeMoments attitude_moments(std::span<const Attitude> attitude);

/// Where the spacecraft points while exposures are taken: exposure k from k cycles + the stagger of its camera on.
class AttitudeModel {
 public:
  AttitudeModel() = default;
  AttitudeModel(const AttitudeModel&) = delete;
  AttitudeModel& operator=(const AttitudeModel&) = delete;
  AttitudeModel(AttitudeModel&&) = delete;
  AttitudeModel& operator=(AttitudeModel&&) = delete;
  virtual ~AttitudeModel() = default;

  /// Calls `visit` for exposures 0 … count-1 with the attitudes at the midpoints of `steps` equal parts of each.
  /// A longer series has the shorter one as its beginning, bit for bit.
  virtual void for_each_exposure(std::int64_t count, int steps,
                                 const std::function<void(std::span<const Attitude>)>& visit) const = 0;
  /// All of them at once, shape (count, steps).
  [[nodiscard]] std::vector<Attitude> sample(std::int64_t count, int steps) const;
  /// Variance of one instant.
  [[nodiscard]] virtual AttitudeVariance variance() const = 0;
  /// Variance of the mean over one exposure, and of the mean of `exposures` successive exposure means.
  [[nodiscard]] virtual AttitudeVariance variance_of_mean(std::int64_t exposures) const = 0;
  /// Covariance, axis by axis, of that mean with the one of exposures that begin `lag` later. variance_of_mean() at 0.
  [[nodiscard]] virtual AttitudeVariance covariance_of_mean(std::int64_t exposures, Seconds lag) const = 0;
  /// Number of equal steps in an exposure that keeps the rms error of its mean attitude below `fraction` of the rms.
  [[nodiscard]] virtual int steps_for(double fraction) const = 0;
  [[nodiscard]] virtual std::string description() const = 0;
};

/// Calls `visit` for exposures 0 … count-1 with attitudes at the midpoints of `steps` equal parts of windows of the
/// length of an exposure that begin `offsets` later than it does: shape (window, step). For rows, or cameras, that are
/// exposed at their own times.
///
/// A longer series has the shorter one as its beginning, bit for bit.
/// @param gapless     a model whose exposures fill the cycle, so that it knows the attitude at any time.
/// @param simulation  of the exposures; offsets are from 0 to a cycle.
/// @accuracy  An attitude is that at the midpoint of the nearest of equal parts of the cycle, none longer than a step:
///            at most half a step away.
void for_each_exposure_at(const AttitudeModel& gapless, const SimulationSettings& simulation,
                          std::span<const Seconds> offsets, std::int64_t count, int steps,
                          const std::function<void(std::span<const Attitude>)>& visit);

/// The attitude of every exposure of a run, computed once and shared by all cameras.
struct AttitudeSeries {
  std::vector<AttitudeMoments> moments;  ///< [exposure][band]; empty when nothing moves
  std::vector<Attitude> samples;         ///< [exposure][band][step], only where exposures are rendered step by step
  std::vector<float> weights;            ///< [exposure][band][map], only where images are a polynomial in the attitude
  int steps = 1;
  int bands = 1;      ///< of rows that are exposed one after the other
  Attitude farthest;  ///< the largest of each axis, in absolute value
};

/// No motion at all.
std::shared_ptr<const AttitudeModel> make_still_attitude();

/// Ornstein–Uhlenbeck jitter by its exact update, x' = a x + s sqrt(1 - a²) n with a = exp(-dt/tau), from a stationary
/// start, one independent process an axis (F29).
///
/// The process goes from instant to instant of all cameras, so those that read out at other times see the same path:
/// each draw is addressed by the number of its instant.
/// @param staggers  s, of every group of cameras; simulation.stagger is one of them. Empty: that alone.
/// @source UhlenbeckOrnstein1930
std::shared_ptr<const AttitudeModel> make_red_noise_attitude(const JitterSettings& jitter,
                                                             const SimulationSettings& simulation,
                                                             const RandomStream& stream,
                                                             std::span<const double> staggers = {});

/// Gaussian jitter with a given power spectral density, the axes independent, as a pure function of absolute time: any
/// instant is the same in a longer run, in a run that is resumed, and for any number of steps. Resolves spectra to 1/16
/// of the frequency; nothing slower than the lowest frequency of the spectrum, so its mean is zero.
/// @param source  what descriptions call the spectrum.
/// @source Shinozuka1991, PrincenBradley1986
std::shared_ptr<const AttitudeModel> make_spectrum_attitude(const JitterSpectrum& spectrum, const std::string& source,
                                                            const SimulationSettings& simulation,
                                                            const RandomStream& stream);

/// Attitude from a file of columns time_s, yaw, pitch, roll (s since start, arcsec), linear between its samples.
/// @throws InputError with every bad line, or when the file does not cover the run.
std::shared_ptr<const AttitudeModel> make_file_attitude(const std::string& path, const SimulationSettings& simulation);

}  // namespace astroid
