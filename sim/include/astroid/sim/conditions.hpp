// What changes so slowly that many exposures share it.
#pragma once

#include <array>

namespace astroid {

/// State of camera and spacecraft at a time. Every member is the neutral value where its effect is off.
struct Conditions {
  double throughput = 1.0;           ///< of the optics, relative to the start of the run
  double psf_variance = 0.0;         ///< added along x and along y, px²
  std::array<double, 3> velocity{};  ///< of the spacecraft relative to the start of the run, ICRS, in units of c

  friend bool operator==(const Conditions&, const Conditions&) = default;
};

}  // namespace astroid
