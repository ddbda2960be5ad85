// How significant a star would be in every pixel: the image filtered by the PSF, in units of the filtered noise.
#pragma once

#include <span>
#include <vector>

#include "field/padded_plane.hpp"
#include "field/star_stamps.hpp"

namespace astroid::detail {

/// A kernel of side x side values as a sum of products of a column and a row.
class SeparableKernel {
 public:
  /// @param kernel  square, of odd side, row by row.  @param tolerance  relative, of the root of the sum of squares
  SeparableKernel(std::span<const double> kernel, double tolerance);
  struct Term {
    std::vector<float> column, row;
  };
  [[nodiscard]] int half() const { return half_; }
  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }

 private:
  int half_ = 0;
  std::vector<Term> terms_;
};

/// A place where a star may be.
struct Peak {
  double x = 0.0;
  double y = 0.0;
  double flux = 0.0;          ///< e-, of a star alone there
  double significance = 0.0;  ///< flux in units of its error
};

class MatchedFilter {
 public:
  explicit MatchedFilter(const PsfReach& reach);

  /// Filters residuals with their weights: flux of a star at each pixel, sum w r p / sum w p², in units of its error
  /// 1 / sqrt(sum w p²).
  void apply(const PaddedPlane& residual, const PaddedPlane& weight);
  /// Local maxima above `threshold`, row by row, to a fraction of a pixel.
  [[nodiscard]] std::vector<Peak> peaks(double threshold) const;
  [[nodiscard]] const PaddedPlane& significance() const { return significance_; }

 private:
  void filter(const PaddedPlane& in, const SeparableKernel& kernel, PaddedPlane& out);

  SeparableKernel kernel_;
  SeparableKernel square_;
  PaddedPlane weighted_;
  PaddedPlane rows_;
  PaddedPlane significance_;
  PaddedPlane information_;  // sum w p²
};

}  // namespace astroid::detail
