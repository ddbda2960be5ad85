// The noiseless image as a polynomial in the attitude and in time: for small motions, one sum of a few fixed maps
// replaces the rendering of every star.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/sim/attitude.hpp"

namespace astroid {

/// Powers of yaw, pitch and roll in one term, and of time in halves of an epoch from its middle.
using AttitudePowers = std::array<int, 4>;

/// Which terms the polynomial has, and where it holds: attitudes within `scale` of the centre of a cell, axis by axis,
/// and times within an epoch. Cells tile the attitudes, so a motion may be larger than one of them.
struct AttitudePolynomial {
  std::vector<AttitudePowers> terms;  ///< the first is the constant; with a term, all of lower powers are there
  Attitude scale;                     ///< half-width of a cell, arcsec; 0 for an axis that does not move

  /// The highest power of time; 0: all times of an epoch share an image.
  [[nodiscard]] int highest_power_of_time() const;
};

/// Where an image is wanted.
struct MotionPoint {
  Attitude attitude;
  double time = 0.0;  ///< from the middle of the epoch, -1 … 1 over it
};

/// How stars move by themselves while time goes by: the k-th derivative of the displacement of any of them is at most
/// px × rate^k, as of a motion in a circle.
struct SlowMotion {
  double px = 0.0;
  double rate = 0.0;  ///< per second, or per half an epoch

  friend bool operator==(const SlowMotion&, const SlowMotion&) = default;
};

/// The largest effect of one power of each axis: displacement of any star by `scale`, px.
struct AttitudeReach {
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
  SlowMotion slow{};  ///< per half an epoch
};

/// Chooses the terms: the fewest whose missing companions change a flux by at most `allowed`, relative.
///
/// A term of total power n changes a flux by at most D_n r1^i r2^j r3^k / (i! j! k!), with D_n the largest n-th
/// derivative of the logarithm's argument (PsfSensitivity::derivatives) and r the reach of each axis. With power l of
/// time D_n becomes rate^l / l! × the sum over q of S(l, q) D_(n+q) px^q, S Stirling's numbers of the second kind
/// (F121).
/// @param derivatives  D_n, index n, px^-n.  @param left_out  [out] the bound on what is missing.
/// @returns no term at all when `most` terms are not enough.
std::vector<AttitudePowers> choose_attitude_terms(std::span<const double> derivatives, const AttitudeReach& reach,
                                                  double allowed, std::size_t most, double& left_out);

/// Centre of the cell that an attitude lies in.
Attitude cell_centre(const AttitudePolynomial& polynomial, const Attitude& attitude);

/// Attitudes at which the image must be known, as many as terms.
/// @source ChkifaCohenSchwab2014 (interpolation on lower sets; the points of each axis are a Leja sequence)
std::vector<MotionPoint> interpolation_points(const AttitudePolynomial& polynomial, const Attitude& centre);

/// Matrix that turns the values at interpolation_points() into the coefficients of the terms, row by row.
std::vector<double> coefficients_from_values(const AttitudePolynomial& polynomial);

/// The mean of each term over the attitudes of an exposure.  @param time  of the exposure, -1 … 1 over the epoch
std::vector<double> mean_of_terms(const AttitudePolynomial& polynomial, const Attitude& centre,
                                  std::span<const Attitude> attitudes, double time = 0.0);

}  // namespace astroid
