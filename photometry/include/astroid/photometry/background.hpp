// The sky under the stars of a single image: a robust mesh over the frame, or an annulus around one star.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/geometry.hpp"

namespace astroid {

/// Median of sorted values that is not stuck on the steps of quantised data: where several values are equal at the
/// middle, they count as spread evenly to half-way to the next values. NaN for no values.
[[nodiscard]] double smoothed_median(std::span<const double> sorted);

/// Level and scatter of a set of pixel values of which some hold stars.
struct SkyEstimate {
  double level = 0.0;      ///< NaN if no pixel was left
  double mode = 0.0;       ///< 2.5 median - 1.5 mean where the two are within 0.3 rms, as SExtractor; else the median
  double rms = 0.0;        ///< of one pixel, corrected for the tails that clipping cuts off a normal distribution
  std::size_t pixels = 0;  ///< that were left after clipping
};

/// Clips values farther than `clip` sigma from the median until nothing changes (at most 100 times).
///
/// @param values  in any order, all finite; sorted by the call.
/// @param mode    true: 2.5 median - 1.5 mean where the two are within 0.3 sigma, as SExtractor does, which undoes half
///                of the bias of faint stars at the price of noise; false: the median.
/// @source BertinArnouts1996 §7.
[[nodiscard]] SkyEstimate clipped_sky(std::vector<double>& values, double clip, bool mode);

/// How the level of the sky follows from the pixels of a cell.
enum class SkyEstimator {
  kLightFit,  ///< clipped median, less the light of stars in it: a fit to the distribution of the pixels around it
  kMode,      ///< 2.5 median - 1.5 mean, as SExtractor
  kMedian
};

struct MeshSettings {
  int cell = 64;      ///< side of a cell, px; cells are stretched so that a whole number of them fills the image
  int filter = 3;     ///< side of the median filter over cells; 1: none
  double clip = 3.0;  ///< sigma
  SkyEstimator estimator = SkyEstimator::kLightFit;
};

/// A smooth background over one region of a frame, in ADU: natural bicubic spline through the centres of the cells.
///
/// @accuracy bias in a field of 1500 stars on 1024² px, sky 20 e-, rms 6.7 e-: 0.0 e- (mode -0.1, median +0.1); of
/// 15,000 stars: -0.1 e- (mode +0.7, median +1.3) (test: BackgroundBias.IsATenthOfAnElectronAtMost).
/// @complexity O(pixels): a histogram for each cell.
/// @source F150, F151; BertinArnouts1996.
class BackgroundMap {
 public:
  /// Estimates from the pixels that are finite and without any flag. Cells with fewer than half of their pixels are
  /// filled from their neighbours; in a frame with none left the map is NaN.
  /// @throws InputError when a setting is not positive.
  /// @source BertinArnouts1996 §7; differs: cells are stretched instead of cut at the last column and row.
  BackgroundMap(const Frame& frame, std::size_t region, const MeshSettings& settings);

  [[nodiscard]] const Rectangle& area() const { return area_; }
  /// @param level  [out] shape (area().nx), ADU, of row y.
  void level_row(int y, std::span<double> level) const;
  /// @param rms  [out] shape (area().nx), ADU, scatter of one pixel, of row y.
  void rms_row(int y, std::span<double> rms) const;
  [[nodiscard]] double median_level() const { return median_level_; }  ///< over the cells, ADU
  [[nodiscard]] double median_rms() const { return median_rms_; }
  /// Of the level in one place, where the scatter of a pixel is `rms`, ADU.
  [[nodiscard]] double level_error(double rms) const { return relative_error_ * rms; }
  /// Of the cells after smoothing, row by row, ADU.
  [[nodiscard]] std::span<const double> cell_levels() const { return level_.value; }
  [[nodiscard]] std::span<const double> cell_rms() const { return rms_.value; }
  /// Share of the pixels that hold more light of stars than a fiftieth of their scatter, as far as the fit can tell;
  /// NaN with another estimator.
  [[nodiscard]] double lit_share() const { return lit_share_; }

 private:
  struct Cells;
  struct Grid {
    std::vector<double> value;      // shape (rows_, columns_)
    std::vector<double> curvature;  // second derivative along y, per cell²
  };
  void fill_empty_cells(std::vector<double>& value) const;
  void filter_cells(std::vector<double>& value, int side) const;
  bool take_out_light(const Frame& frame, Cells& cells);
  [[nodiscard]] Grid make_grid(std::vector<double> value) const;
  void grid_row(const Grid& grid, int y, std::span<double> out) const;

  Rectangle area_;
  std::size_t columns_ = 0;  // of cells
  std::size_t rows_ = 0;
  Grid level_;
  Grid rms_;
  double median_level_ = 0.0;
  double median_rms_ = 0.0;
  double relative_error_ = 0.0;
  double lit_share_ = 0.0;
};

/// Takes the background out of a region of a frame but leaves the bias in, which calibration removes.
void subtract_background(Frame& frame, std::size_t region, const BackgroundMap& background);

/// Background around one star: clipped median of the pixels whose centres are inner … outer px away.
struct AnnulusBackground {
  double level = 0.0;  ///< ADU; NaN with fewer than `kFewestAnnulusPixels` pixels
  double error = 0.0;  ///< of the level, ADU: sqrt(pi/2) rms / sqrt(pixels), the noise of a median
  double rms = 0.0;
  std::size_t pixels = 0;
};
inline constexpr std::size_t kFewestAnnulusPixels = 12;

/// Uses the pixels that are finite and without any flag.
/// @param clip  sigma from the median beyond which pixels are left out; infinity: the plain median.
[[nodiscard]] AnnulusBackground annulus_background(const Frame& frame, std::size_t region, PixelPosition centre,
                                                   double inner, double outer, double clip = 3.0);

}  // namespace astroid
