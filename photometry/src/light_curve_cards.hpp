// What the light-curve files say of their time axis.
#pragma once

#include <vector>

#include "astroid/core/fits_card.hpp"

namespace astroid::detail {

/// Time system, reference and unit, as lightkurve and astropy expect them.
inline std::vector<FitsCard> time_cards() {
  constexpr int kReferenceDay = 2457000;
  return {{"TELESCOP", "ASTROID", "simulated and measured by ASTROID"},
          {"TIMESYS", "TDB", "time system"},
          {"BJDREFI", kReferenceDay, "integer part of the BJD of TIME = 0"},
          {"BJDREFF", 0.0, "fraction of the BJD of TIME = 0"},
          {"TIMEUNIT", "d", "unit of TIME"}};
}

}  // namespace astroid::detail
