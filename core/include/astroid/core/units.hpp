// Units as types: a wrong combination does not compile. Gain is always e-/ADU.
#pragma once

#include <compare>

namespace astroid {

/// A double with a unit. Quantities of one unit add, subtract and compare; they scale by plain numbers;
/// the ratio of two is a plain number. Products of different units exist only where they are listed below.
template <class Unit>
class Quantity {
 public:
  constexpr Quantity() = default;
  constexpr explicit Quantity(double value) : value_(value) {}
  [[nodiscard]] constexpr double value() const { return value_; }

  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.value_ + b.value_); }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.value_ - b.value_); }
  friend constexpr Quantity operator-(Quantity a) { return Quantity(-a.value_); }
  friend constexpr Quantity operator*(Quantity a, double s) { return Quantity(a.value_ * s); }
  friend constexpr Quantity operator*(double s, Quantity a) { return Quantity(s * a.value_); }
  friend constexpr Quantity operator/(Quantity a, double s) { return Quantity(a.value_ / s); }
  friend constexpr double operator/(Quantity a, Quantity b) { return a.value_ / b.value_; }
  friend constexpr auto operator<=>(Quantity, Quantity) = default;  // NOLINT(modernize-use-nullptr): not a pointer

 private:
  double value_ = 0.0;
};

namespace unit {
struct Electrons;          ///< photo-electrons
struct ExpectedElectrons;  ///< mean number of electrons of a pixel, before shot noise; a plane's unit
struct SampledElectrons;   ///< drawn number of electrons of a pixel, after shot noise; a plane's unit
struct ElectronsPerSecond;
struct Adu;
struct ElectronsPerAdu;
struct Seconds;
struct Pixels;
struct Degrees;
struct Radians;
struct Arcseconds;
struct ArcsecondsPerPixel;
struct DeltaMag;
struct Ppm;
struct Relative;  ///< dimensionless factor; a plane's unit
struct Flags;     ///< bit mask; a plane's unit
}  // namespace unit

using Electrons = Quantity<unit::Electrons>;
using ElectronsPerSecond = Quantity<unit::ElectronsPerSecond>;
using Adu = Quantity<unit::Adu>;
using Gain = Quantity<unit::ElectronsPerAdu>;
using Seconds = Quantity<unit::Seconds>;
using Pixels = Quantity<unit::Pixels>;
using Degrees = Quantity<unit::Degrees>;
using Radians = Quantity<unit::Radians>;
using Arcseconds = Quantity<unit::Arcseconds>;
using PixelScale = Quantity<unit::ArcsecondsPerPixel>;
using DeltaMag = Quantity<unit::DeltaMag>;
using Ppm = Quantity<unit::Ppm>;

// A table, one line a rule.
// clang-format off
constexpr Electrons operator*(ElectronsPerSecond rate, Seconds t) { return Electrons(rate.value() * t.value()); }
constexpr Electrons operator*(Seconds t, ElectronsPerSecond rate) { return rate * t; }
constexpr ElectronsPerSecond operator/(Electrons n, Seconds t) { return ElectronsPerSecond(n.value() / t.value()); }
constexpr Electrons operator*(Adu counts, Gain gain) { return Electrons(counts.value() * gain.value()); }
constexpr Electrons operator*(Gain gain, Adu counts) { return counts * gain; }
constexpr Adu operator/(Electrons n, Gain gain) { return Adu(n.value() / gain.value()); }
constexpr Pixels operator/(Arcseconds angle, PixelScale scale) { return Pixels(angle.value() / scale.value()); }
constexpr Arcseconds operator*(Pixels distance, PixelScale scale) { return Arcseconds(distance.value() * scale.value()); }

inline constexpr double kPi = 3.141592653589793238462643383279502884;
inline constexpr double kFwhmPerSigma = 2.35482004503094938202313865291939;  ///< of a Gaussian, 2 sqrt(2 ln 2)
inline constexpr double kSecondsPerDay = 86400.0;
inline constexpr double kArcsecondsPerDegree = 3600.0;
constexpr Radians to_radians(Degrees angle) { return Radians(angle.value() * (kPi / 180.0)); }
constexpr Degrees to_degrees(Radians angle) { return Degrees(angle.value() * (180.0 / kPi)); }
constexpr Arcseconds to_arcseconds(Degrees angle) { return Arcseconds(angle.value() * kArcsecondsPerDegree); }
constexpr Degrees to_degrees(Arcseconds angle) { return Degrees(angle.value() / kArcsecondsPerDegree); }
constexpr Radians to_radians(Arcseconds angle) { return to_radians(to_degrees(angle)); }
// clang-format on

/// An astronomical magnitude: affine, so mag - mag = DeltaMag, mag + DeltaMag = mag, and mag + mag does not compile.
class Magnitude {
 public:
  constexpr Magnitude() = default;
  constexpr explicit Magnitude(double value) : value_(value) {}
  [[nodiscard]] constexpr double value() const { return value_; }
  friend constexpr DeltaMag operator-(Magnitude a, Magnitude b) { return DeltaMag(a.value_ - b.value_); }
  friend constexpr Magnitude operator+(Magnitude a, DeltaMag d) { return Magnitude(a.value_ + d.value()); }
  friend constexpr Magnitude operator-(Magnitude a, DeltaMag d) { return Magnitude(a.value_ - d.value()); }
  friend constexpr auto operator<=>(Magnitude, Magnitude) = default;  // NOLINT(modernize-use-nullptr): not a pointer

 private:
  double value_ = 0.0;
};

}  // namespace astroid
