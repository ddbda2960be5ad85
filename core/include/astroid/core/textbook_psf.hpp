// How other tools put a star on pixels, and the slow exact way: for comparison with the renderers, never for images.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "astroid/core/psf.hpp"

namespace astroid {

/// Surface brightness of a star of unit flux, 1/px², at (dx, dy) px from the star.
using SurfaceBrightness = std::function<double(double dx, double dy)>;

/// Of a circular Gaussian.  @param sigma  px, > 0
SurfaceBrightness gaussian_brightness(double sigma);
/// Of a table: the mixed derivative of the running integral that make_prf_psf() keeps exactly; 0 beside the table.
SurfaceBrightness table_brightness(const PsfTable& table);

/// What a table means, without an approximation: every pixel is the mixed difference of the running integral.
/// @accuracy  1e-15 of the star's light  @complexity  16 products for each corner of a pixel
std::shared_ptr<const PixelPsf> make_exact_table_psf(const PsfTable& table);

enum class TextbookMethod : std::uint8_t {
  kSnap,           ///< integrated exactly, at the centre of the nearest of n × n sub-pixels
  kMidpoint,       ///< n × n samples per pixel of the surface brightness, at the true place
  kGaussLegendre,  ///< n × n nodes per pixel
  kLinear,         ///< exact images at n × n phases of the pixel, bilinear in between
  kCubic,          ///< the same, four-point Lagrange interpolation along both axes
};
std::string to_string(TextbookMethod method, int n);

/// What make_textbook_psf() is made from.
struct TextbookSource {
  std::shared_ptr<const PixelPsf> exact;  ///< for what is tabulated, and for the size of stamps
  SurfaceBrightness brightness;           ///< for what is sampled
  int reach = 10;                         ///< px: what is tabulated ends here
};

/// @param n  1 … 1000; 1 … 10 for kGaussLegendre
/// @throws InputError for another n.
/// @accuracy  unknown (approximation_error() is NaN): to measure it is what this is for. For a Gaussian of 0.6 px and
///            3 × 3 px: see the test TextbookMethods.HaveTheErrorsOfThePublishedTable.
std::shared_ptr<const PixelPsf> make_textbook_psf(TextbookMethod method, int n, TextbookSource source);
/// Bytes of what a method tabulates.
double textbook_bytes(TextbookMethod method, int n, int reach);

}  // namespace astroid
