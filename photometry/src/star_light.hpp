// Where the light of the stars is believed to fall.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid::detail {

/// Whether a star sheds light: finite position on or near a detector, finite positive flux.
[[nodiscard]] bool shines(const FieldStar& star);

/// Half-widths of the stamps outside of which a star adds less than `lost_electrons`, cached by decade of flux.
class StampSizes {
 public:
  /// @param fixed  px; where > 0 every star has this half-width.
  StampSizes(const PixelPsf& psf, double lost_electrons, double fixed);
  [[nodiscard]] double half_width(double electrons);

 private:
  const PixelPsf& psf_;
  double lost_electrons_;
  double fixed_;
  std::vector<double> by_decade_;  // NaN: not asked for yet
};

/// The stamp of every star of the model; empty for those that do not shine.
std::vector<Rectangle> star_stamps(const GroundModel& model, const PhotometrySettings& settings);

/// For each window, which stars' stamps touch it: those of window i are star[first[i]] … star[first[i+1]-1], ascending.
struct Overlaps {
  std::vector<std::size_t> first;
  std::vector<std::size_t> star;
};
Overlaps stamps_on_windows(std::span<const Rectangle> stamps, std::span<const Rectangle> windows);

/// Adds the light of one star inside its stamp to an image over `box`.
/// @param light    [in,out] shape (box.ny, box.nx), e-.
/// @param scratch  reused memory.
void add_star(const PixelPsf& psf, const FieldStar& star, const Rectangle& stamp, const Rectangle& box,
              std::span<double> light, std::vector<double>& scratch);

/// Central difference for d ln F/dx: its own error is h²/6 F''' ~ 1e-6 of the gradient, rounding adds 1e-13.
inline constexpr double kGradientStep = 1e-3;  // px

/// Adds how the light of one star changes when it moves by 2 kGradientStep along x or y, as add_star() does.
void add_change(const PixelPsf& psf, const FieldStar& star, const Rectangle& stamp, const Rectangle& box, bool along_x,
                std::span<double> light, std::vector<double>& scratch);

/// Expected light of all stars over a layout, e- per exposure. Stars are added in the order of the model.
Plane<double, unit::ExpectedElectrons> expected_light(const PixelLayout& layout, const GroundModel& model,
                                                      std::span<const Rectangle> stamps);

}  // namespace astroid::detail
