// The noiseless image as a polynomial in the attitude: for small motions, one sum of a few fixed maps replaces the
// rendering of every star.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/sim/attitude.hpp"

namespace astroid {

/// Powers of yaw, pitch and roll in one term.
using AttitudePowers = std::array<int, 3>;

/// Which terms the polynomial has, and where it holds: attitudes within `scale` of the centre of a cell, axis by axis.
/// Cells tile the attitudes, so a motion may be larger than one of them.
struct AttitudePolynomial {
  std::vector<AttitudePowers> terms;  ///< the first is the constant; with a term, all of lower powers are there
  Attitude scale;                     ///< half-width of a cell, arcsec; 0 for an axis that does not move
};

/// The largest effect of one power of each axis: displacement of any star by `scale`, px.
struct AttitudeReach {
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
};

/// Chooses the terms: the fewest whose missing companions change a flux by at most `allowed`, relative.
///
/// A term of total power n changes a flux by at most D_n r1^i r2^j r3^k / (i! j! k!), with D_n the largest n-th
/// derivative of the logarithm's argument (PsfSensitivity::derivatives) and r the reach of each axis.
/// @param derivatives  D_n, index n, px^-n.  @param left_out  [out] the bound on what is missing.
/// @returns no term at all when `most` terms are not enough.
std::vector<AttitudePowers> choose_attitude_terms(std::span<const double> derivatives, const AttitudeReach& reach,
                                                  double allowed, std::size_t most, double& left_out);

/// Centre of the cell that an attitude lies in.
Attitude cell_centre(const AttitudePolynomial& polynomial, const Attitude& attitude);

/// Attitudes at which the image must be known, as many as terms.
/// @source ChkifaCohenSchwab2014 (interpolation on lower sets; the points of each axis are a Leja sequence)
std::vector<Attitude> interpolation_points(const AttitudePolynomial& polynomial, const Attitude& centre);

/// Matrix that turns the values at interpolation_points() into the coefficients of the terms, row by row.
std::vector<double> coefficients_from_values(const AttitudePolynomial& polynomial);

/// The mean of each term over the attitudes of an exposure.
std::vector<double> mean_of_terms(const AttitudePolynomial& polynomial, const Attitude& centre,
                                  std::span<const Attitude> attitudes);

}  // namespace astroid
