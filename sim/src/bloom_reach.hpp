// How far charge can bloom, from what the catalogue says.
#pragma once

#include <vector>

#include "astroid/sim/scene.hpp"

namespace astroid {

/// Bounds the rows from which charge may bloom into a region.
///
/// Charge only comes through pixels that are full, and a run of n full pixels held at least n full wells before: so the
/// stars whose light may fall on it, with 10 % and ten standard deviations to spare, and n times the background must
/// reach that. Other light in single pixels (particles, hot pixels) counts for the 10 %.
class BloomReach {
 public:
  explicit BloomReach(const Scene& scene);

  /// The region with all rows that charge may come from. @complexity O(n²) for n stars in 16 columns
  [[nodiscard]] Rectangle support(const Rectangle& region) const;

 private:
  struct Source {
    double x;
    double y;
    double electrons;
  };
  [[nodiscard]] Rectangle support_of_columns(const Rectangle& region) const;

  Rectangle detector_;
  double room_ = 0.0;   ///< of a pixel without stars, e-
  double width_ = 0.0;  ///< light of a star falls within this of its position, px
  std::vector<Source> sources_;
};

}  // namespace astroid
