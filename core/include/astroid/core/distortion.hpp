// Distortion by the optics: where the light that a perfect camera would focus in one place really falls.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// Coefficients of radial and tangential distortion, in the plane in which the focal length is 1.
///
/// With r² = x² + y² a star that a perfect camera has at (x, y) falls on
///   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²) + s1 r²
///   y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y + s2 r².
/// k: radial; p: decentring; s: thin prism. In Wang2008's form, x' = … + a1 r² + x (b1 x + b2 y) and
/// y' = … + a2 r² + y (b1 x + b2 y), the same coefficients are p1 = b2/2, p2 = b1/2, s1 = a1 - b1/2, s2 = a2 - b2/2.
/// @source Brown1966, Weng1992, Wang2008
struct RadialTangential {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0;
  double p1 = 0.0, p2 = 0.0;
  double s1 = 0.0, s2 = 0.0;

  friend bool operator==(const RadialTangential&, const RadialTangential&) = default;
};

/// Simple Imaging Polynomial: offsets (u, v) in pixels from the optical axis, as measured, become those of a perfect
/// camera, u + Σ A_ij uⁱ vʲ and v + Σ B_ij uⁱ vʲ with 2 <= i + j <= order.  @source Shupe2005
struct SipPolynomial {
  static constexpr int kHighestOrder = 9;
  int order = 0;            ///< 0: no distortion; else 2 .. kHighestOrder
  std::vector<double> a{};  ///< A_ij at index(i, j), unit px^(1-i-j)
  std::vector<double> b{};  ///< B_ij likewise

  SipPolynomial() = default;
  /// With all coefficients 0.
  explicit SipPolynomial(int highest) : order(highest), a(size(highest)), b(size(highest)) {}
  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(order + 1) + static_cast<std::size_t>(j);
  }
  friend bool operator==(const SipPolynomial&, const SipPolynomial&) = default;

 private:
  static std::size_t size(int highest) {
    return static_cast<std::size_t>(highest + 1) * static_cast<std::size_t>(highest + 1);
  }
};

/// A distortion and its inverse, both exact. Positions are offsets from the optical axis in pixels, along the
/// detector's x and y. Immutable; the same bits on every processor.
///
/// What is folded is refused: a place counts only if the Jacobian's determinant and trace are positive all along the
/// straight line (in the plane where the polynomial is explicit) from the axis to it. Of the two directions the one
/// that is a polynomial is evaluated; the other is found by Newton's method with the analytic Jacobian, steps halved
/// until the residual falls without crossing a fold, and by continuation from the axis should that fail (N6).
/// @accuracy  residual below 1e-9 px for offsets up to 1e5 px (test: Distortion.ReturnsWhereItCameFrom)
/// @thread safe
class Distortion {
 public:
  Distortion() = default;
  Distortion(const Distortion&) = delete;
  Distortion& operator=(const Distortion&) = delete;
  Distortion(Distortion&&) = delete;
  Distortion& operator=(Distortion&&) = delete;
  virtual ~Distortion() = default;

  /// Where the light that a perfect camera has at `ideal` falls; nothing beyond a fold.
  [[nodiscard]] virtual std::optional<PixelShift> distort(PixelShift ideal) const = 0;
  /// Where a perfect camera would have the light that falls on `real`; nothing beyond a fold.
  [[nodiscard]] virtual std::optional<PixelShift> undistort(PixelShift real) const = 0;
  /// The polynomial of undistort(), where it is one.
  [[nodiscard]] virtual const SipPolynomial* sip() const { return nullptr; }
  [[nodiscard]] virtual std::string description() const = 0;
};

/// @param focal_length  px: of the scale at the axis, 206264.8 / (arcsec/px).
/// @throws InputError when a coefficient or the focal length is not usable.
std::shared_ptr<const Distortion> make_radial_distortion(const RadialTangential& coefficients, Pixels focal_length);

/// @throws InputError when the order is not 2 .. 9 or a coefficient is not finite.
std::shared_ptr<const Distortion> make_sip_distortion(SipPolynomial polynomial);

/// The polynomial of a FITS file: A_ORDER, B_ORDER, A_i_j and B_i_j of the primary header, absent terms 0.
/// @throws InputError naming every unusable keyword; EnvironmentError when the file cannot be read.
SipPolynomial read_sip_polynomial(const std::string& path);

/// A polynomial that stands for a distortion's undistort() in a FITS header.
struct SipFit {
  SipPolynomial polynomial{};
  double worst = 0.0;  ///< largest distance from undistort(), px, over the fitted area
};

/// The lowest order, up to SipPolynomial::kHighestOrder, that is within `tolerance` px of undistort() over `offsets`
/// (least squares at Chebyshev points), or the highest.
/// @param offsets  pixels, relative to the optical axis: the detector's own box moved by it.
/// @returns        nothing where the distortion folds inside the area.
std::optional<SipFit> fit_sip(const Distortion& distortion, const Rectangle& detector, PixelPosition axis,
                              double tolerance);

}  // namespace astroid
