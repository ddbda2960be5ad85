// The profile of a Gaussian star across the pixels of an axis, from a table: many stars, fast.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace astroid::detail {

/// Fractions of a Gaussian in the pixels around it, along one axis, as Taylor expansions in the sub-pixel phase.
///
/// Nodes lie so close that six terms give 1e-13 of the star. A profile is a sum of the rows of one node, and everything
/// one may want of it is a choice of weights: at a phase, moved, or broadened by motion (F26).
/// @accuracy  1e-13 absolute for kNarrowest <= sigma <= kWidest (test: GaussianProfiles.AreTheIntegrals).
class GaussianProfiles {
 public:
  static constexpr double kNarrowest = 0.15;  // px
  static constexpr double kWidest = 4.0;
  static constexpr std::size_t kTerms = 6;
  static constexpr std::size_t kPadding = 16;  ///< readable doubles beyond the last pixel of a row

  explicit GaussianProfiles(double sigma);

  /// Weighted rows of one node: fraction in pixel i = sum_k weights[k] * rows[k * stride + i - first].
  struct Axis {
    const double* rows = nullptr;  ///< of the first pixel
    std::array<double, kTerms> weights{};
    int first = 0;  ///< pixel of rows[0]
    int size = 0;   ///< pixels; beyond them is less than 1e-14 of the star
  };
  /// @param variance  of the motion along this axis, px²; the profile is its mean, to the second order.
  [[nodiscard]] Axis axis(double position, double variance) const;
  /// Derivative with respect to the position.
  [[nodiscard]] Axis slope(double position) const;
  [[nodiscard]] std::size_t stride() const { return stride_; }

 private:
  struct Phase {
    Axis axis;
    double offset;  // from the node
  };
  [[nodiscard]] Phase phase(double position) const;

  int nodes_;
  int reach_;                 // pixels on either side of the one that holds the star
  std::size_t stride_;        // of the rows
  std::vector<double> rows_;  // [node][term][pixel]
};

}  // namespace astroid::detail
