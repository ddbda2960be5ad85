// Predicted and measured numbers of every target: what analysis/targets.csv holds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/mission.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// What was put in: one star of the truth table.
struct TruthStar {
  std::string id;
  double ra = 0.0, dec = 0.0;  ///< deg, NaN for a pixel catalogue
  double magnitude = 0.0;      ///< in the zero point's passband
  double x = 0.0, y = 0.0;     ///< px, of the reference epoch and pointing
  double electrons = 0.0;      ///< per exposure
};

}  // namespace astroid
