// The PSF of every star of a field and its derivatives, on stamps as large as the star's brightness asks for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/geometry.hpp"
#include "astroid/core/psf.hpp"

namespace astroid::detail {

/// A star of the model of a field.
struct ModelStar {
  double x = 0.0;  ///< px
  double y = 0.0;
  double flux = 0.0;    ///< e-
  int half = 0;         ///< half-side of its stamp, px
  double change = 0.0;  ///< of its flux in the last step, in units of its error alone
};

/// How far a star of given flux reaches, and other things asked of a PSF once for a field.
class PsfReach {
 public:
  /// @param psf     taken at `centre`.  @param limit  most half-side of a stamp, px
  PsfReach(const PixelPsf& psf, PixelPosition centre, int limit);

  /// Half-side of the stamp beyond which no pixel gets more than `level` e- of a star.
  [[nodiscard]] int half(double flux, double level) const;
  [[nodiscard]] double peak() const { return edge_.front(); }          ///< largest share of a star in a pixel
  [[nodiscard]] double fwhm() const { return fwhm_; }                  ///< px, of a Gaussian with as many noise pixels
  [[nodiscard]] double noise_pixels() const { return noise_pixels_; }  ///< 1 / sum p², of a star at a pixel's centre
  [[nodiscard]] int core() const { return core_; }  ///< half-side of the square with 99.9 % of sum p², px
  [[nodiscard]] int most() const { return static_cast<int>(edge_.size()) - 1; }
  /// The fractions around a star at the centre of a pixel, square of half-side core(), row by row.
  [[nodiscard]] std::span<const double> kernel() const { return kernel_; }

 private:
  std::vector<double> edge_;  // largest fraction in a pixel farther than r from the star's, along an axis
  std::vector<double> kernel_;
  double fwhm_ = 0.0;
  double noise_pixels_ = 0.0;
  int core_ = 1;
};

/// p, dp/dx and dp/dy of one star in the pixels x0 … x0+side-1, y0 … y0+side-1. Rows are `stride` apart and end in at
/// least three zeros.
struct StampView {
  const float* p = nullptr;
  const float* px = nullptr;
  const float* py = nullptr;
  int x0 = 0;
  int y0 = 0;
  int side = 0;
  int stride = 0;
};

class StarStamps {
 public:
  explicit StarStamps(const PixelPsf& psf) : psf_(psf) {}

  /// Computes the stamps of `stars` anew; those whose place did not change since the last time are kept.
  void update(std::span<const ModelStar> stars);
  [[nodiscard]] StampView operator[](std::size_t i) const;

  static int stride_of(int half) { return (2 * half + 7) & ~3; }

 private:
  struct Place {
    std::size_t offset = 0;
    double x = 0.0;
    double y = 0.0;
    int half = -1;
    int x0 = 0;
    int y0 = 0;
  };
  void compute(const ModelStar& star, Place& place);

  const PixelPsf& psf_;
  std::vector<Place> places_;
  std::vector<float> pool_;
  std::vector<double> scratch_;
};

}  // namespace astroid::detail
