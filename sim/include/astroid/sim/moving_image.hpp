// The noiseless image of a camera that moves little: fixed maps, and their sum for the attitude of an exposure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/sim/attitude_polynomial.hpp"
#include "astroid/sim/recent_images.hpp"
#include "astroid/sim/strip.hpp"

namespace astroid {

/// Renders the noiseless image at one attitude and time of the epoch.
using RenderAt = std::function<Plane<double, unit::ExpectedElectrons>(const MotionPoint&)>;

/// The maps of one cell of attitudes in one epoch: the image is base + sum of map × term.
struct MovingImageCell {
  Plane<double, unit::ExpectedElectrons> base;
  std::vector<Plane<float, unit::ExpectedElectrons>> maps;  ///< of terms 1, 2, …
};

/// Weights of the maps for an exposure with these attitudes: the means of the terms but the first, about the centre of
/// the cell that their mean lies in.  @param time  of the exposure, -1 … 1 over the epoch
std::vector<float> exposure_weights(const AttitudePolynomial& polynomial, std::span<const Attitude> attitudes,
                                    double time = 0.0);

/// Makes cells where attitudes lead, and keeps the latest ones. @thread safe
class MovingImage {
 public:
  /// @param pixels  of an image, on which it depends how many cells are kept.
  MovingImage(AttitudePolynomial polynomial, std::size_t pixels);

  /// The image of one exposure: the maps of its cell and the weight of each.
  struct Exposure {
    std::shared_ptr<const MovingImageCell> cell;
    std::span<const float> weights;
    /// The pixels of a strip.
    void recall(const Strip& strip, std::span<double> expected) const;
  };
  /// @param epoch    of the slow conditions that `render` renders with.
  /// @param mean     attitude of the exposure, which decides the cell.
  /// @param weights  of exposure_weights().
  /// @param render   makes the images of a cell that is not at hand.
  [[nodiscard]] Exposure exposure(std::int64_t epoch, const Attitude& mean, std::span<const float> weights,
                                  const RenderAt& render) const;

 private:
  struct Key {
    std::int64_t epoch;
    std::array<double, 3> centre;
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] MovingImageCell make_cell(const Attitude& centre, const RenderAt& render) const;

  AttitudePolynomial polynomial_;
  std::vector<double> inverse_;
  RecentImages<Key, MovingImageCell> cells_;
};

}  // namespace astroid
