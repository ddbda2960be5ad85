// The attitude of each exposure, measured in its own image by how the bright stars have moved.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/attitude.hpp"
#include "astroid/core/frame.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {

/// A star that shows the attitude by where it is.
struct GuideStar {
  std::size_t star = 0;     ///< index into GroundModel::stars
  AttitudeJacobian motion;  ///< px per arcsec
};

/// What an image says of the attitude.
struct MeasuredAttitude {
  Attitude mean;           ///< of the exposure, arcsec
  std::size_t guides = 0;  ///< that were used
};

/// Measures yaw, pitch and roll of one exposure from all guide stars together.
///
/// The light in the window of a guide star is linear in a small displacement: data = f light + b + D displacement. Flux
/// and background of each star are nuisances and eliminated; what is left are two weighted sums of pixels a star, a
/// displacement with its information. The attitude is the least-squares solution over all stars, with a prior of zero
/// mean and the given reach, which decides only what the stars do not see (roll in a small field). A star with a
/// saturated or bad pixel is left out of that exposure, and so is one that contradicts the others by more than five
/// sigma (a particle).
/// @valid  displacements small against the PSF: relative error 1e-4 at 0.04 px, 1e-3 at 0.1 px with sigma = 0.7 px
/// (test: AttitudeSensor.IsLinearForSmallDisplacements)
/// @source F130
class AttitudeSensor {
 public:
  /// @param layout    pixels that the frames will have.
  /// @param guides    the best first: one whose window is cut, or shares pixels with one before it, is not used.
  /// @param model     with every star that sheds light on the windows; they all move with the attitude.
  /// @param settings  side of the windows, and how far neighbours reach.
  /// @param reach     arcsec, largest deviation that is to be expected of each axis; an axis of 0 stays 0.
  AttitudeSensor(const PixelLayout& layout, const GroundModel& model, const PhotometrySettings& settings,
                 std::span<const GuideStar> guides, const Attitude& reach);

  /// @param frame  over the layout.  @rng none  @thread safe  @complexity O(guides × window)
  /// @accuracy same bits on every processor; covariance() (test: AttitudeSensor.MeasuresAsWellAsItSays)
  [[nodiscard]] MeasuredAttitude measure(const Frame& frame) const;

  /// Of the error of one exposure in which all guide stars are used, arcsec².
  [[nodiscard]] AttitudeCovariance covariance() const;
  /// Guide stars that are used.
  [[nodiscard]] std::size_t guides() const { return guides_.size(); }

 private:
  struct Guide {
    std::size_t begin = 0, end = 0;       // in pixels_
    AttitudeJacobian motion;              // px per unit of reach
    double xx = 0.0, xy = 0.0, yy = 0.0;  // information of its displacement, px^-2
  };
  struct Displacement {
    bool good = false;
    double x = 0.0, y = 0.0;  // information times displacement, px^-1
  };
  struct Pixel {
    std::uint32_t index;
    double x, y;  // weights, px^-1 per e-
  };
  struct Normal;

  void add_guide(const GuideStar& guide, const Rectangle& window, std::size_t first_pixel, std::size_t width,
                 std::span<const double> light, std::span<const double> along_x, std::span<const double> along_y,
                 const PixelNoise& noise);
  [[nodiscard]] Displacement read(const Guide& guide, const Frame& frame) const;
  /// Chi² of two degrees of freedom: how far a star is from where the attitude puts it.
  [[nodiscard]] double contradiction(const Guide& guide, const Displacement& measured,
                                     const std::array<double, 3>& attitude) const;
  [[nodiscard]] Normal normal(std::span<const Displacement> displacements) const;

  Attitude reach_;
  double gain_;
  std::vector<Guide> guides_;
  std::vector<Pixel> pixels_;
};

}  // namespace astroid
