// Builds the estimator of one target after another; what build_estimators() is made of.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/photometry/estimator.hpp"
#include "cell_grid.hpp"
#include "psf_weights.hpp"
#include "star_light.hpp"

namespace astroid::detail {

/// Fewest annulus pixels that are trusted with a local background.
inline constexpr std::size_t kFewestBackgroundPixels = 12;

/// The pixels that the estimator of each target may use with weight; empty for unusable positions.
std::vector<Rectangle> aperture_windows(const GroundModel& model, const PhotometrySettings& settings);

/// The mean of the annulus pixels of a target.
struct Annulus {
  bool usable = false;
  double star_light = 0.0;  ///< e-, the sum that the pixels are believed to carry
  double error = 0.0;       ///< e-, of the mean: noise and doubt
  double doubt = 0.0;       ///< e-, of the mean: that of the stars' light alone
};

/// How the light in each pixel of a window changes when all stars move by 2 kGradientStep, e-.
struct LightChange {
  std::vector<double> target, contaminants;
};

class StarEstimatorBuilder {
 public:
  StarEstimatorBuilder(const PixelLayout& layout, const GroundModel& model, const PhotometrySettings& settings);

  /// @param window      of aperture_windows().
  /// @param neighbours  indices of stars whose stamps touch the window, ascending; may include the target.
  [[nodiscard]] StarEstimator build(std::size_t star, const Rectangle& window, std::span<const std::size_t> neighbours);

  /// Of the targets that are built from now on, e- per pixel.
  void set_background(double background) { noise_.background = background; }

  [[nodiscard]] std::span<const Rectangle> stamps() const { return stamps_; }

 private:
  bool choose_region(const FieldStar& star, const Rectangle& window, StarEstimator& estimator);
  void expected_in_window(std::size_t star, const Rectangle& window, std::span<const std::size_t> neighbours);
  /// Weights of the window's pixels, 0 outside the aperture, as if no edge were near.
  bool choose_weights(const FieldStar& star, const Rectangle& window);
  void cut_at_edges(const FieldStar& star, const Rectangle& window, StarEstimator& estimator);
  void fill_budget(const Rectangle& window, StarEstimator& estimator);
  void add_background(const FieldStar& star, const Rectangle& window, StarEstimator& estimator);
  void find_annulus_pixels(const FieldStar& star, const Rectangle& window, const StarEstimator& estimator);
  /// Fills annulus_, and found_ with its pixels.
  void choose_annulus(const FieldStar& star, const Rectangle& window, const StarEstimator& estimator);
  void add_local_background(double weight_sum, StarEstimator& estimator);
  /// Weights of the charge of each pixel, whose signal appears in its neighbours too; weights_ without coupling.
  const std::vector<double>& couple_weights(const Rectangle& window);
  /// Noise that the pixels of a column or row share (pattern_noise.cpp).
  void add_pattern_noise(const Rectangle& window, StarEstimator& estimator);
  // Of levels that calibration subtracts (calibration_noise.cpp).
  void smear_window(const Rectangle& window);
  void add_calibration_noise(StarEstimator& estimator);
  // Of PSF weights (psf_estimator.cpp).
  void light_of_each(std::size_t star, const Rectangle& window, std::span<const std::size_t> neighbours);
  bool choose_psf_weights(const FieldStar& star, const Rectangle& window, const StarEstimator& estimator);
  void judge_blend(const Rectangle& window, StarEstimator& estimator);
  void doubt_motion();
  /// Fills change_x_ and change_y_.
  void differentiate(std::size_t star, const Rectangle& box, std::span<const std::size_t> neighbours);
  void fill_gradients(std::size_t star, std::span<const std::size_t> neighbours, StarEstimator& estimator);

  const PixelLayout& layout_;
  const GroundModel& model_;
  const PhotometrySettings& settings_;
  PixelNoise noise_;  // at the target at hand
  std::vector<Rectangle> stamps_;
  CellGrid regions_;
  bool fits_psf_;
  Plane<double, unit::ExpectedElectrons> light_;  // only for a local background

  // Of the target at hand, over its window; kept between targets to reuse their memory.
  std::vector<double> target_;
  std::vector<double> contaminants_;
  std::vector<double> total_;  // what makes photon noise: both, and what is smeared over them
  std::vector<double> weights_;
  std::vector<double> coupled_weights_;
  std::vector<double> fractions_;  // of PSF weights alone
  std::vector<double> scratch_;
  std::vector<std::size_t> found_;
  std::vector<double> column_weights_;
  std::vector<double> row_weights_;
  Annulus annulus_;
  LightChange change_x_, change_y_;
  std::vector<double> doubts_;  // of PSF weights: shape (doubts, pixels), e-; neighbours first
  std::size_t neighbours_ = 0;  // rows of doubts_
  double known_sigma_ = 0.0;    // e-, of the flux if neighbours and background were known
  PsfScratch psf_scratch_;
};

}  // namespace astroid::detail
