// Charge diffusion of a table.
#pragma once

#include "astroid/core/psf.hpp"

namespace astroid::detail {

/// The table convolved with a Gaussian and extended by the kernel's reach. Samples wider than sigma are divided, into
/// at most finest_division parts per axis; a kernel narrower than a sample keeps its variance, within sigma⁴ of the
/// rest.
PsfTable diffuse(const PsfTable& table, double sigma, int finest_division);

}  // namespace astroid::detail
