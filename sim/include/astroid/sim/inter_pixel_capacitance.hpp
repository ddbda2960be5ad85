// Inter-pixel capacitance: the voltage of a pixel's node follows its neighbours' charge a little.
#pragma once

#include "astroid/core/image.hpp"
#include "astroid/core/inter_pixel_coupling.hpp"

namespace astroid {

/// Signal of the nodes of an image: every pair of neighbours exchanges the coupling times the difference of their
/// charges, which is a 3 x 3 convolution that conserves charge also at the edge, where neighbours are missing.
///
/// @param charge  e- on each node.  @param signal  [out] e-, of the same area; must not overlap.
/// @accuracy  the sum of the signal is that of the charge to 1e-12 relative
///            (test: InterPixelCapacitance.ConservesCharge).
/// @complexity O(pixels) (bench: BM_InterPixelCapacitance)  @rng none  @thread safe
/// @source Moore2006 for the network; McCullough2008 for the 3 x 3 kernel. F91
void couple_pixels(const ImageView<const double, unit::SampledElectrons>& charge, const InterPixelCoupling& coupling,
                   const ImageView<double, unit::SampledElectrons>& signal);

}  // namespace astroid
