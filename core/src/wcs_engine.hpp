// WCSLIB's structure as a value, and a stock of copies so that threads need not share one.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/geometry.hpp"

struct wcsprm;

namespace astroid {

struct WcsDeleter {
  void operator()(wcsprm* wcs) const;
};
using WcsPointer = std::unique_ptr<wcsprm, WcsDeleter>;

/// A two-dimensional celestial WCS ready for use by any number of threads. Coordinates are those of the WCS (degrees of
/// its own longitude and latitude) and FITS pixels (1-based).
class WcsEngine {
 public:
  /// @param wcs  has passed wcsset(); axes 2, both celestial.
  explicit WcsEngine(WcsPointer wcs);

  /// Projects positions; where there is no image the pixel is NaN.
  void to_pixels(std::span<const SkyPosition> world, std::span<PixelPosition> pixels) const;
  /// NaN where there is none.
  [[nodiscard]] SkyPosition to_world(PixelPosition pixel) const;
  [[nodiscard]] const wcsprm& wcs() const { return *original_; }

 private:
  class Lease;
  WcsPointer original_;
  mutable std::mutex mutex_;
  mutable std::vector<WcsPointer> idle_;
  mutable std::size_t copies_ = 0;
};

/// A copy of the structure, or of its celestial part only, ready for use.
/// @throws std::runtime_error with WCSLIB's words.
[[nodiscard]] WcsPointer copy_wcs(const wcsprm& original, bool celestial_only = false);

/// WCSLIB's words for a status.
[[nodiscard]] std::string wcs_message(int status);

}  // namespace astroid
