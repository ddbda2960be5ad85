// The noiseless image of a camera that moves little: fixed maps, and their sum for the attitude of an exposure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/sim/attitude_polynomial.hpp"
#include "astroid/sim/strip.hpp"

namespace astroid {

/// Renders the noiseless image at one attitude.
using RenderAt = std::function<Plane<double, unit::ExpectedElectrons>(const Attitude&)>;

/// The maps of one cell of attitudes: the image is base + sum of map × term.
struct MovingImageCell {
  Plane<double, unit::ExpectedElectrons> base;
  std::vector<Plane<float, unit::ExpectedElectrons>> maps;  ///< of terms 1, 2, …
};

/// Makes cells where attitudes lead, and keeps the latest ones. @thread safe
class MovingImage {
 public:
  explicit MovingImage(AttitudePolynomial polynomial);

  /// The image of one exposure: the maps of its cell and the weight of each.
  struct Exposure {
    std::shared_ptr<const MovingImageCell> cell;
    std::vector<float> weights;
    /// The pixels of a strip.
    void recall(const Strip& strip, std::span<double> expected) const;
  };
  /// @param steps  the attitudes of the exposure; its mean decides the cell.
  /// @param render  makes the images of a cell that is not at hand.
  [[nodiscard]] Exposure exposure(std::span<const Attitude> steps, const RenderAt& render) const;

 private:
  [[nodiscard]] std::shared_ptr<const MovingImageCell> cell(const Attitude& centre, const RenderAt& render) const;
  [[nodiscard]] std::shared_ptr<const MovingImageCell> make_cell(const Attitude& centre, const RenderAt& render) const;

  AttitudePolynomial polynomial_;
  std::vector<double> inverse_;
  mutable std::mutex mutex_;
  mutable std::map<std::array<double, 3>, std::shared_ptr<const MovingImageCell>> cells_;
  mutable std::vector<std::array<double, 3>> age_;  // of cells_, the oldest first
};

}  // namespace astroid
