// A star that the field's solver did not settle, fitted again with its nearest neighbours.
#pragma once

#include <cstddef>

#include "astroid/photometry/group_fit.hpp"
#include "field/field_solver.hpp"

namespace astroid::detail {

/// Whether the last step of the field's solver still changed a star's flux by more than a tenth of its error.
bool is_unsettled(const ModelStar& star);

/// One star with those within two FWHM of it free, all others and the sky as the field has them.
FittedStar settle(const FieldSolver& field, std::size_t star);

}  // namespace astroid::detail
