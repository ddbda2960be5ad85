// What was put in: only the analysis sees it beside what came out.
#pragma once

#include <string>

namespace astroid {

/// One star of truth/stars.csv.
struct TruthStar {
  std::string id;
  double ra = 0.0, dec = 0.0;  ///< deg, NaN for a pixel catalogue
  double magnitude = 0.0;      ///< in the zero point's passband
  double x = 0.0, y = 0.0;     ///< px, at the nominal pointing
  double electrons = 0.0;      ///< per exposure
};

}  // namespace astroid
