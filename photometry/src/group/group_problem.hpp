// A group of stars as a problem of Ceres: one residual for each pixel.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/photometry/group_fit.hpp"

namespace astroid::detail {

struct GroupParameters {
  std::vector<double> flux;                  // e-
  std::vector<std::array<double, 2>> place;  // px
  double background = 0.0;                   // e- per pixel
};

struct GroupSolve {
  bool positions = true;
  bool background = true;
  bool robust = false;      ///< a Cauchy loss at `outlier` sigma
  double outlier = 5.0;     ///< sigma
  double most_shift = 1.0;  ///< px, from where the stars are now
  int most_iterations = 50;
};

/// Solves for the parameters. @param variance  of every pixel  @param usable  @returns whether it converged
bool solve_group(const GroupPixels& pixels, std::span<const double> variance, std::span<const char> usable,
                 const PixelPsf& psf, const GroupSolve& solve, GroupParameters& parameters);

struct GroupCovariance {
  bool known = false;                        ///< false: what is asked for cannot be told from these pixels
  std::vector<std::array<double, 6>> stars;  // FF, Fx, Fy, xx, xy, yy
  double background = 0.0;
};

GroupCovariance group_covariance(const GroupPixels& pixels, std::span<const double> variance,
                                 std::span<const char> usable, const PixelPsf& psf, const GroupSolve& solve,
                                 GroupParameters& parameters);

}  // namespace astroid::detail
