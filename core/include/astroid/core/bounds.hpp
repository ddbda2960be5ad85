// What theory allows at best: noise-equivalent area and Cramér-Rao bounds of a point source.
#pragma once

#include <array>
#include <span>

namespace astroid {

/// Noise-equivalent area 1 / sum p_n^2 in pixels; 4 pi (sigma^2 + 1/12) for a well sampled Gaussian.
/// @param fractions  fractions of the star's flux per pixel. +inf when they are all zero. @source King1983;
/// Mighell1999.
double noise_equivalent_area(std::span<const double> fractions);

/// A star on a known background: its flux and the variance that each pixel has without it.
struct SourceOnBackground {
  double electrons = 0.0;   ///< e- per exposure
  double background = 0.0;  ///< sky + dark + readout noise squared, e-^2 per pixel (Gaussian approximation)
};

/// Smallest possible standard deviation of the flux at a known position, e-: 1 / sqrt(sum p^2 / (F p + B)).
/// Limits: sqrt(F), and sqrt(4 pi sigma^2 B) for a Gaussian in the dark. @source Mendez2014.
double flux_bound(std::span<const double> fractions, const SourceOnBackground& star);

/// Smallest possible standard deviation of one coordinate at a known flux, px: 1 / sqrt(sum (F dp/dx)^2 / (F p + B)).
/// @param gradient  dp/dx per pixel, 1/px. @source Mendez2013.
double position_bound(std::span<const double> fractions, std::span<const double> gradient,
                      const SourceOnBackground& star);

/// Smallest possible standard deviations when flux, position and a flat background are all unknown.
struct JointBounds {
  double flux = 0.0;                                  ///< e-
  double x = 0.0, y = 0.0;                            ///< px
  double background = 0.0;                            ///< e- per pixel
  std::array<std::array<double, 4>, 4> covariance{};  ///< order: flux, x, y, background
};

/// Inverse of the 4 x 4 Fisher matrix. Infinite where the data cannot tell the parameters apart.
JointBounds joint_bounds(std::span<const double> fractions, std::span<const double> dpdx, std::span<const double> dpdy,
                         const SourceOnBackground& star);

}  // namespace astroid
