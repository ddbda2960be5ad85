// The stars of a field that a PSF is measured from.
#pragma once

#include <cstddef>
#include <vector>

#include "field/field_solver.hpp"

namespace astroid::detail {

/// Indices, ascending, of the brightest `most` stars with at least `snr` that have all pixels of their core, and at
/// most half as much light of others in it as of their own.
std::vector<std::size_t> choose_psf_stars(const FieldSolver& field, double snr, std::size_t most);

}  // namespace astroid::detail
