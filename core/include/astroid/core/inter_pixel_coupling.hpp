// Inter-pixel capacitance as both simulation and ground describe it.
#pragma once

#include <memory>

#include "astroid/core/psf.hpp"

namespace astroid {

/// How much of a pixel's signal appears in each of its neighbours.
struct InterPixelCoupling {
  double side = 0.0;    ///< each of the four at its sides
  double corner = 0.0;  ///< each of the four at its corners
  /// Share of its own signal that a pixel away from the edge keeps.
  [[nodiscard]] double own() const { return 1.0 - 4.0 * (side + corner); }
};

/// The PSF as seen in the images of a detector with inter-pixel capacitance: fractions spread over 3 x 3 pixels. What a
/// ground segment measures from stars has it, so this is the PSF that it believes.
/// @accuracy  exact away from the edge of the detector, where neighbours are missing. @source F91
std::shared_ptr<const PixelPsf> make_coupled_psf(std::shared_ptr<const PixelPsf> psf,
                                                 const InterPixelCoupling& coupling);

}  // namespace astroid
