#include "astroid/sim/strip.hpp"

#include <algorithm>

namespace astroid {

namespace {

Strip strip_of(std::span<const Rectangle> regions) {
  Strip strip;
  for (const Rectangle& region : regions) strip.add(region);
  return strip;
}

}  // namespace

Strip whole_strip(const PixelLayout& layout) {
  return strip_of(layout.regions());
}

Strip exposed_strip(const PixelLayout& layout) {
  return strip_of(layout.exposed_regions());
}

std::vector<Strip> make_strips(const PixelLayout& layout, std::size_t pixels, int band_rows) {
  std::vector<Strip> strips;
  Strip strip;
  const auto finish = [&] {
    Strip next;
    next.begin = next.end = strip.end;
    next.exposed = strip.exposed;
    if (strip.size() > 0) strips.push_back(std::move(strip));
    strip = std::move(next);
  };
  const std::size_t exposed = layout.exposed_regions().size();
  for (std::size_t r = 0; r < layout.regions().size(); ++r) {
    if (r == exposed) {
      finish();
      strip.exposed = false;
    }
    const Rectangle& region = layout.regions()[r];
    if (region.empty()) continue;
    const auto width = static_cast<std::size_t>(region.nx);
    for (int y = region.y0; y < region.y1();) {
      const std::size_t room = pixels > strip.size() ? pixels - strip.size() : 0;
      int end = region.y1();
      if (band_rows > 0 && y >= 0) end = std::min(end, (y / band_rows + 1) * band_rows);
      const auto rows = static_cast<int>(std::clamp<std::size_t>(room / width, 1, static_cast<std::size_t>(end - y)));
      strip.add({region.x0, y, region.nx, rows});
      y += rows;
      if (strip.size() + width > pixels) finish();
    }
  }
  finish();
  return strips;
}

}  // namespace astroid
