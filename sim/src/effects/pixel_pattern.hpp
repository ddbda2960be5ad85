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

/// The pixels of a strip in one exposure.
inline PixelPlaces noise_of(const Strip& strip, std::int64_t exposure) {
  return {.areas = strip.areas, .exposure = static_cast<std::uint32_t>(exposure)};
}

/// Fills a plane with value(normal), the same in every exposure: addressed by detector pixel, so a window has the
/// pattern of the full frame. @param draw  another one where the effect draws from exposure 0 besides.
template <class Unit, class Value>
void draw_fixed_pattern(const RandomStream& stream, Plane<float, Unit>& plane, Value&& value, std::uint16_t draw = 0) {
  constexpr std::size_t kAtOnce = 8192;
  std::vector<float> normals;
  for (const Strip& strip : make_strips(plane.layout(), kAtOnce)) {
    normals.resize(strip.size());
    PixelPlaces places = noise_of(strip, 0);
    places.draw = draw;
    pixel_normals(stream, places, normals);
    std::ranges::transform(normals, plane.pixels().subspan(strip.begin, strip.size()).begin(),
                           [&](float normal) { return static_cast<float>(value(static_cast<double>(normal))); });
  }
}

}  // namespace astroid
