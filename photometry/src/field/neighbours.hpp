// Which stars of a field are near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/star_stamps.hpp"

namespace astroid::detail {

/// Stars in square cells; lists are in the order of indices.
class Neighbours {
 public:
  Neighbours() = default;
  /// @param reach  px, largest distance that find() will be asked for
  Neighbours(std::span<const ModelStar> stars, double reach);

  /// Indices of the stars within `distance` of (x, y), ascending. @param distance at most `reach`
  void find(double x, double y, double distance, std::vector<std::uint32_t>& found) const;

 private:
  std::span<const ModelStar> stars_;
  double cell_ = 1.0;
  double x0_ = 0.0;
  double y0_ = 0.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> members_;
};

}  // namespace astroid::detail
