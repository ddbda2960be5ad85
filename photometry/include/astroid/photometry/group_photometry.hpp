// Photometry at given places of single images by fits of few stars: slow, but careful with each.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/group_fit.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid {

struct GroupPhotometrySettings {
  std::shared_ptr<const PixelPsf> psf;  ///< needed
  double psf_error = 0.0;               ///< sigma of what the PSF's error does to a flux, relative; it is in flux_err
  MeshSettings mesh;                    ///< of the first estimate of the sky
  std::shared_ptr<const BackgroundMap> map;  ///< instead of one made with `mesh`
  Magnitude zero_point{0.0};
  GroupFitSettings fit;
};

/// Fits flux and place of every source on region 0 of a frame, and a constant sky under each group on that of the mesh.
///
/// Sources that share pixels (within two FWHM, less where that makes groups of more than ten) are fitted together,
/// the light of all others taken out as it was last fitted, up to four times. Places move by a FWHM (1 px) at most.
/// Flagged pixels have no weight: a saturated star is measured by its wings.
/// @throws InputError without a PSF, or when positions are in the sky and `sky` is nullptr.
/// @complexity about 5 ms for each source  @source F147
std::vector<SourceMeasurement> measure_groups(const Frame& frame, const SkyProjection* sky,
                                              std::span<const SourceRequest> sources,
                                              const GroupPhotometrySettings& settings);

}  // namespace astroid
