// What a ground segment does to a frame before it measures stars: bias from prescan, response of the electronics, gain
// of the nodes, smearing from overscan rows.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/image.hpp"
#include "astroid/core/readout_nodes.hpp"
#include "astroid/core/response.hpp"
#include "astroid/photometry/reference_pixels.hpp"

namespace astroid {

/// What the ground believes of a detector's readout, and what it corrects.
struct CalibrationModel {
  Rectangle detector;  ///< its light-sensitive pixels; others of a frame are reference pixels
  int nodes = 1;
  Gain gain{1.0};
  Adu bias;
  Electrons readout_noise;         ///< of the noisiest node, to tell cosmic rays in reference pixels from it
  bool measure_bias = false;       ///< from the prescan, exposure by exposure
  bool subtract_smearing = false;  ///< of overscan rows, column by column
  ElectronicResponse response;     ///< believed, to be undone; linear: leave it
  std::array<double, kMostNodes> gain_factors{1.0, 1.0, 1.0, 1.0};  ///< believed gain / `gain`, node by node
};

/// Calibrates the frames of one layout. Immutable; workers share it, each with its own scratch.
///
/// A calibrated frame still holds the believed bias, so estimators need not know what was done. Flags are not changed.
/// Reference pixels are those of the layout beside the detector: prescan at x < 0 (and, with two nodes a row, at
/// x >= columns for the other side), overscan at y >= rows (and, with four nodes, at y < 0 for the lower half).
class FrameCalibration {
 public:
  /// Memory that a worker lends; what it holds between calls means nothing.
  struct Scratch {
    std::vector<double> levels;
    std::vector<float> values;
  };

  /// Levels that cannot be measured, as no finite pixel is left, make the pixels of their column NaN.
  /// @throws InputError when what is to be corrected needs reference pixels that the layout does not have.
  FrameCalibration(const PixelLayout& layout, const CalibrationModel& model);

  /// Whether apply() leaves every frame as it is.
  [[nodiscard]] bool does_nothing() const { return !bends_ && !model_.measure_bias && !model_.subtract_smearing; }

  /// @thread safe, each with its own scratch
  /// @complexity  O(pixels), one pass over them for each kind of correction (bench: BM_Calibrate)
  void apply(Frame& frame, Scratch& scratch) const;

  /// e-², variance of the bias level that is measured in one exposure; 0 where the believed one is taken. With several
  /// nodes that of the one with the fewest reference pixels.
  [[nodiscard]] double bias_variance() const;
  /// Overscan rows whose mean is subtracted; 0 where smearing stays.
  [[nodiscard]] int overscan_rows() const { return model_.subtract_smearing ? overscan_rows_ : 0; }

 private:
  struct Columns {
    std::size_t region;  // light-sensitive
    int y0, y1;          // its rows that are read in one direction
    std::size_t level;   // where the levels of its columns begin
  };
  [[nodiscard]] bool is_light_sensitive(const Rectangle& region) const;
  [[nodiscard]] double measured_bias(const Frame& frame, int node, Scratch& scratch) const;
  void straighten(Frame& frame, std::span<const double> bias) const;
  void subtract_smearing(Frame& frame, Scratch& scratch) const;

  CalibrationModel model_;
  ReferenceNoise noise_;
  bool bends_ = false;                                        // whether pixels change by response or gain
  std::array<std::vector<std::size_t>, kMostNodes> prescan_;  // regions, of each node
  std::size_t fewest_prescan_ = 0;                            // pixels of a node
  std::vector<std::size_t> overscan_;                         // regions
  std::vector<std::size_t> level_begins_;                     // of the columns of each
  std::size_t levels_ = 0;                                    // of all of them
  std::vector<Columns> columns_;
  int overscan_rows_ = 0;
};

}  // namespace astroid
