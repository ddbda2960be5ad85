#include "astroid/sim/strip.hpp"

#include <algorithm>

namespace astroid {

Strip whole_strip(const PixelLayout& layout) {
  Strip strip;
  for (const Rectangle& region : layout.regions()) strip.add(region);
  return strip;
}

std::vector<Strip> make_strips(const PixelLayout& layout, std::size_t pixels) {
  std::vector<Strip> strips;
  Strip strip;
  for (std::size_t r = 0; r < layout.regions().size(); ++r) {
    const Rectangle& region = layout.regions()[r];
    if (region.empty()) continue;
    const auto width = static_cast<std::size_t>(region.nx);
    for (int y = region.y0; y < region.y1();) {
      const std::size_t room = pixels > strip.size() ? pixels - strip.size() : 0;
      const auto rows =
          static_cast<int>(std::clamp<std::size_t>(room / width, 1, static_cast<std::size_t>(region.y1() - y)));
      strip.add({region.x0, y, region.nx, rows});
      y += rows;
      if (strip.size() + width <= pixels) continue;
      const std::size_t next = strip.end;
      strips.push_back(std::move(strip));
      strip = {};
      strip.begin = strip.end = next;
    }
  }
  if (strip.size() > 0) strips.push_back(std::move(strip));
  return strips;
}

}  // namespace astroid
