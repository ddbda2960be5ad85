// Requests as rows of a table that is still to be filled, and what the pixels around a row say.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/image_photometry.hpp"

namespace astroid::detail {

/// Rows with id and places, all else NaN.
/// @throws InputError when a position is in the sky and `sky` is nullptr.
std::vector<SourceMeasurement> rows_of(std::span<const SourceRequest> sources, const SkyProjection* sky);

/// Whether a place is on a pixel of the area.
bool on_frame(PixelPosition place, const Rectangle& area);

/// kEdge, kSaturated and kBadPixel of the square of half-side `half` px around a place.
std::uint32_t pixel_flags_around(const Frame& frame, PixelPosition place, int half);

/// Whether a pixel may be fitted to: no flag but those that photometry takes no notice of, and a number below 1e12.
bool may_be_fitted(unsigned flags, float value);

}  // namespace astroid::detail
