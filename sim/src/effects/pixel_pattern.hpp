// Addresses of the draws of pixels, and fixed patterns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/strip.hpp"

namespace astroid {

/// The pixels of a piece in one exposure.
inline PixelRows noise_of(const StripPiece& piece, std::int64_t exposure) {
  return {.address = {.x0 = piece.area.x0, .y = piece.area.y0, .exposure = static_cast<std::uint32_t>(exposure)},
          .rows = static_cast<std::size_t>(piece.area.ny)};
}

/// Fills a plane with value(normal), the same in every exposure: addressed by detector pixel, so a window has the
/// pattern of the full frame.
template <class Unit, class Value>
void draw_fixed_pattern(const RandomStream& stream, Plane<float, Unit>& plane, Value&& value) {
  constexpr std::size_t kAtOnce = 8192;
  std::vector<float> normals;
  for (const Strip& strip : make_strips(plane.layout(), kAtOnce))
    for (const StripPiece& piece : strip.pieces) {
      normals.resize(piece.area.size());
      pixel_normals(stream, noise_of(piece, 0), normals);
      std::ranges::transform(normals, plane.pixels().subspan(piece.begin, piece.area.size()).begin(),
                             [&](float normal) { return static_cast<float>(value(static_cast<double>(normal))); });
    }
}

}  // namespace astroid
