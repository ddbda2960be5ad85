// Sky to pixels and back.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "astroid/core/attitude.hpp"
#include "astroid/core/boresight.hpp"
#include "astroid/core/distortion.hpp"
#include "astroid/core/fits_card.hpp"
#include "astroid/core/geometry.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// Where a camera points and how its detector lies behind the optics.
///
/// With roll 0, x grows to the west (decreasing right ascension) and y to the north: CD = scale * [-1 0; 0 1]. Roll
/// turns the star field in the image counter-clockwise (from +x to +y) about the axis position, as FITS' CROTA2 does:
/// CD = scale * [-cos -sin; -sin cos]. At the poles the right ascension of the axis says which way is north.
struct CameraPointing {
  SkyPosition axis{};  ///< of the optical axis, ICRS
  Degrees roll{};
  PixelScale scale{1.0};           ///< at the axis
  PixelPosition axis_pixel{};      ///< where the axis falls, 0-based
  std::string projection = "TAN";  ///< one of supported_projections()
  /// Of the optics, in pixels along the detector's x and y from the axis; nothing: a perfect camera.
  std::shared_ptr<const Distortion> distortion{};
  /// Pixels that headers have to describe; asked for where a distortion is given.
  Rectangle detector{};
  /// About whose axes yaw, pitch and roll turn; nothing: those of this camera.
  std::optional<Boresight> spacecraft{};
};

/// The zenithal projections of FITS WCS that a pointing may use: TAN, SIN, ARC, STG, ZEA.  @source Calabretta2002 §5.1
[[nodiscard]] std::span<const std::string_view> supported_projections();

/// Pixel positions that come from WCSLIB are rounded to this many pixels, 2^-24 (0.9 microarcsec at 15 arcsec/px), so
/// that the last bits of the C library's sine, which differ between processors, almost never show.
inline constexpr double kPixelGrid = 0x1p-24;

/// To the nearest multiple of kPixelGrid, halves up. The only place where positions are rounded.
[[nodiscard]] PixelPosition round_to_pixel_grid(PixelPosition position);

/// How far the coordinates of a FITS header may be from the simulated ones, px.
inline constexpr double kHeaderTolerance = 1e-3;

/// A celestial coordinate system of an image, computed by WCSLIB. Immutable; copies share it.
/// @thread safe: every thread works on its own copy of WCSLIB's structure, which is not thread-safe when shared.
/// @source Greisen2002, Calabretta2002
class SkyProjection {
 public:
  /// @throws InputError when the projection is unknown, the scale is not positive or a coordinate is out of range.
  explicit SkyProjection(const CameraPointing& pointing);

  /// From the keywords of a FITS image header: any celestial WCS that WCSLIB reads, with its distortions (SIP, TPV …).
  /// Equatorial (ICRS, or FK5 of J2000, taken as the same) and galactic coordinates are known; positions are ICRS.
  /// @param header  the header's 80-character lines, one after the other (FitsReader::header_text)
  /// @param file    for messages
  /// @returns       nothing when the header has no celestial coordinates.
  /// @throws InputError when it has unusable ones, naming the file and WCSLIB's reason.
  static std::optional<SkyProjection> from_header(const std::string& header, const std::string& file);

  /// Where on the detector a direction falls, rounded by round_to_pixel_grid().
  ///
  /// Nothing where the projection has no image: for TAN and SIN 90 deg or more from the axis (N3), for ARC, STG and ZEA
  /// the antipode, beyond a fold of the distortion, elsewhere where WCSLIB says so or its inverse of a distortion does
  /// not converge.
  /// @accuracy 1e-13 deg on the sky before rounding; the axis position exactly for the axis itself.
  [[nodiscard]] std::optional<PixelPosition> to_pixel(SkyPosition position) const;

  /// to_pixel() of many, the same bits as one by one.
  [[nodiscard]] std::vector<std::optional<PixelPosition>> to_pixels(std::span<const SkyPosition> positions) const;

  /// The direction that falls on a pixel position; exactly the axis for the axis position; NaN where there is none.
  [[nodiscard]] SkyPosition to_sky(PixelPosition position) const;

  /// Derivative of the pixel position under small rotations of the camera, rounded to kJacobianGrid.
  ///
  /// Central differences of sixth order over rotations of up to 10 arcmin, shorter near the edge of the projection.
  /// @accuracy 1e-8 of the largest member, up to 0.1 deg from the projection's edge.
  /// @returns nothing where to_pixel() has nothing.
  [[nodiscard]] std::optional<AttitudeJacobian> attitude_jacobian(SkyPosition position) const;

  /// Angle between the optical axis and the direction that falls on a pixel position, by arithmetic that is the same on
  /// every processor; nothing where to_sky() has nothing. Only for a projection made from a pointing (else BugError).
  /// @accuracy 1e-12 deg beside to_sky(), up to 1 deg from the projection's edge.
  [[nodiscard]] std::optional<Degrees> field_angle(PixelPosition position) const;

  /// Where the optical axis (for a header: the reference point) falls and points.
  [[nodiscard]] PixelPosition axis_pixel() const;
  [[nodiscard]] SkyPosition axis() const;
  /// Square root of the area of the pixel at the axis.
  [[nodiscard]] PixelScale pixel_scale() const;
  [[nodiscard]] const std::string& code() const;  ///< "TAN"

  /// The keywords that describe this projection in an image whose first pixel is (x0, y0) of the detector: CTYPE,
  /// CUNIT, CRPIX (1-based), CRVAL, CD, LONPOLE, RADESYS, and the distortion as SIP: exact where it is one, else a
  /// polynomial over the whole detector that keeps to it within kHeaderTolerance. AP and BP, which could only
  /// approximate an inverse that readers find themselves, are left out. Empty where no SIP polynomial is that good: no
  /// coordinates are better than wrong ones. Only for a projection made from a pointing (else BugError).
  [[nodiscard]] std::vector<FitsCard> fits_cards(int x0 = 0, int y0 = 0) const;

 private:
  struct State;
  explicit SkyProjection(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace astroid
