// Fields of Gaussian stars on a flat sky, drawn by a generator of their own: erf by libm, no code of the simulator.
#pragma once

#include <cstdint>
#include <vector>

#include "astroid/core/frame.hpp"

namespace astroid::test {

struct TrueStar {
  double x = 0.0;  ///< px
  double y = 0.0;
  double flux = 0.0;  ///< e-
};

/// Counts ∝ 10^(slope mag) between two magnitudes; a star of magnitude 25 is one electron. Gain 1, bias 0.
struct StarFieldSettings {
  int nx = 512;
  int ny = 512;
  int stars = 0;
  double fwhm = 2.5;  ///< px, before the pixel
  double slope = 0.25;
  double bright = 12.5;
  double faint = 20.5;
  double sky = 20.0;        ///< e-/px
  double read_noise = 5.0;  ///< e-
  std::uint64_t seed = 1;
};

struct StarField {
  Frame frame;
  std::vector<TrueStar> stars;
};

[[nodiscard]] StarField make_star_field(const StarFieldSettings& settings);

}  // namespace astroid::test
