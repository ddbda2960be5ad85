// Builds the estimator of one target after another; what build_estimators() is made of.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/photometry/estimator.hpp"
#include "cell_grid.hpp"
#include "star_light.hpp"

namespace astroid::detail {

/// Fewest annulus pixels that are trusted with a local background.
inline constexpr std::size_t kFewestBackgroundPixels = 12;

/// The pixels that the estimator of each target may use with weight; empty for unusable positions.
std::vector<Rectangle> aperture_windows(const GroundModel& model, const PhotometrySettings& settings);

class StarEstimatorBuilder {
 public:
  StarEstimatorBuilder(const PixelLayout& layout, const GroundModel& model, const PhotometrySettings& settings);

  /// @param window      of aperture_windows().
  /// @param neighbours  indices of stars whose stamps touch the window, ascending; may include the target.
  [[nodiscard]] StarEstimator build(std::size_t star, const Rectangle& window, std::span<const std::size_t> neighbours);

  [[nodiscard]] std::span<const Rectangle> stamps() const { return stamps_; }

 private:
  bool choose_region(const FieldStar& star, const Rectangle& window, StarEstimator& estimator);
  void expected_in_window(std::size_t star, const Rectangle& window, std::span<const std::size_t> neighbours);
  /// Weights of the window's pixels, 0 outside the aperture, as if no edge were near.
  bool choose_weights(const FieldStar& star, const Rectangle& window);
  void cut_at_edges(const FieldStar& star, const Rectangle& window, StarEstimator& estimator);
  void fill_budget(const Rectangle& window, StarEstimator& estimator);
  void add_background(const FieldStar& star, StarEstimator& estimator);
  void find_annulus_pixels(const FieldStar& star, const StarEstimator& estimator);
  bool add_local_background(const FieldStar& star, StarEstimator& estimator);
  void fill_gradients(std::size_t star, std::span<const std::size_t> neighbours, StarEstimator& estimator);

  const PixelLayout& layout_;
  const GroundModel& model_;
  const PhotometrySettings& settings_;
  std::vector<Rectangle> stamps_;
  CellGrid regions_;
  Plane<double, unit::ExpectedElectrons> light_;  // only for a local background

  // Of the target at hand, over its window; kept between targets to reuse their memory.
  std::vector<double> target_;
  std::vector<double> contaminants_;
  std::vector<double> total_;
  std::vector<double> weights_;
  std::vector<double> scratch_;
  std::vector<std::size_t> found_;
};

}  // namespace astroid::detail
