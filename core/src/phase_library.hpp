// Pixel-integrated images of a PSF table at regular sub-pixel phases, interpolated in between.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/pixel_response.hpp"
#include "astroid/core/psf.hpp"
#include "flux_spline.hpp"

namespace astroid::detail {

/// Fractions of a star's flux per pixel, tabulated for stars at (p, q) / phases px from a pixel's centre, p and q from
/// 0 to phases - 1, with four-point Lagrange interpolation in both axes in between.
///
/// A star anywhere is at such a phase of the pixel to its lower left, so neighbouring nodes may belong to the next
/// pixel: the interpolation runs across pixel boundaries without a seam, and sums to one wherever the star is.
class PhaseLibrary {
 public:
  /// @param response  sensitivity within every pixel, by which the light is weighted.
  PhaseLibrary(const FluxSpline& spline, int phases, PixelResponse response = {});

  void integrate(PixelPosition star, Rectangle box, std::span<double> fractions) const;
  void integrate_gradient(PixelPosition star, Rectangle box, std::span<double> dpdx, std::span<double> dpdy) const;
  /// image += electrons × the fractions of integrate(), in the pixels of `box` that the library reaches.
  void add(PixelPosition star, double electrons, Rectangle box,
           const ImageView<double, unit::ExpectedElectrons>& image) const;

  [[nodiscard]] int phases() const { return phases_; }
  /// Memory of a library of so many phases, bytes.
  static double bytes(const FluxSpline& spline, int phases);

  /// Where errors are judged.
  struct Judged {
    double least = 0.0;  ///< share of the star's flux: a square with less light is judged as if it had this much
    Rectangle outer;     ///< px relative to the star's: squares lie within
    Rectangle hole;      ///< and touch none of these
  };
  /// The pixels of the library but those at the border of the table, where its light may end in a step.
  [[nodiscard]] Rectangle interior() const;
  /// Largest error of the light in squares of 2 and 3 px, relative to that light, wherever they lie in the star's
  /// image: about the star, or in its wings where a fainter star may be. Of stars midway between the phases, where the
  /// interpolation is at its worst.
  [[nodiscard]] double measured_error(const FluxSpline& spline, const Judged& judged) const;

 private:
  static constexpr std::size_t kTaps = 4;
  // One node of the interpolation along an axis: which phase, how many pixels further, and its weights for the value
  // and for the derivative with respect to the star's position.
  struct Tap {
    int phase = 0;
    int shift = 0;
    double weight = 0.0;
    double slope = 0.0;
  };
  struct Axis {
    int pixel = 0;  // whose centre is at or below the star
    std::array<Tap, kTaps> taps{};
  };
  // With an empty border, so that the neighbouring phases of a star cover the same pixels.
  struct Extent {
    int first = 0;  // pixel relative to the star's, of the library's first column or row
    int size = 0;
  };
  static Extent extent(double lower, double upper);
  [[nodiscard]] Axis axis(double position) const;
  [[nodiscard]] const double* image(int phase_x, int phase_y) const;
  // Calls f(library row, output index, count, tap x, tap y) for every run of pixels that a tap reaches.
  template <class F>
  void for_each_run(const Axis& x, const Axis& y, Rectangle box, F&& f) const;

  // Exact fractions of stars `shifts` from the centre of their pixel, shape (shift y, shift x, row, column).
  [[nodiscard]] std::vector<double> exact_images(const FluxSpline& spline, std::span<const double> shifts) const;

  int phases_;
  PixelResponse response_;
  Extent x_;
  Extent y_;
  std::vector<double> images_;  // [phase y][phase x][row][column]
};

}  // namespace astroid::detail
