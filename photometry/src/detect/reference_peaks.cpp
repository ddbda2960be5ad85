#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detect/peaks.hpp"

namespace astroid::detail {

std::vector<FilteredPeak> reference_peaks(const SmoothImage& image, const PeakSettings& settings) {
  struct Region {
    std::size_t top;                 // pixel
    std::vector<std::size_t> stars;  // their highest pixels
    std::vector<std::size_t> pixels;
  };
  std::vector<std::size_t> order;
  for (int y = 0; y < image.ny(); ++y)
    for (int x = 0; x < image.nx(); ++x)
      if (static_cast<double>(image.at(x, y)) > settings.footprint) order.push_back(image.index(x, y));
  const auto height = [&](std::size_t i) { return static_cast<double>(image.values()[i]); };
  const auto is_higher = [&](std::size_t a, std::size_t b) {
    return height(a) > height(b) || (height(a) == height(b) && a < b);
  };
  std::sort(order.begin(), order.end(), is_higher);
  constexpr std::size_t kDry = static_cast<std::size_t>(-1);
  std::vector<std::size_t> region_of(image.values().size(), kDry);
  std::vector<Region> regions;
  const std::size_t stride = image.stride();
  for (const std::size_t pixel : order) {
    std::vector<std::size_t> touching;
    for (const std::size_t q : {pixel - stride - 1, pixel - stride, pixel - stride + 1, pixel - 1, pixel + 1,
                                pixel + stride - 1, pixel + stride, pixel + stride + 1})
      if (region_of[q] != kDry) touching.push_back(region_of[q]);
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    if (touching.empty()) {
      region_of[pixel] = regions.size();
      regions.push_back({pixel, {pixel}, {pixel}});
      continue;
    }
    std::sort(touching.begin(), touching.end(),
              [&](std::size_t a, std::size_t b) { return is_higher(regions[a].top, regions[b].top); });
    Region& into = regions[touching.front()];
    region_of[pixel] = touching.front();
    into.pixels.push_back(pixel);
    for (std::size_t k = 1; k < touching.size(); ++k) {
      Region& from = regions[touching[k]];
      const double saddle = height(pixel);
      const double noise = std::sqrt(1.0 + settings.photon_noise * std::max(0.0, saddle));
      const double depth = std::max(settings.prominence * noise, settings.contrast * height(into.top));
      if (height(from.top) >= settings.threshold && height(from.top) - saddle >= depth)
        into.stars.insert(into.stars.end(), from.stars.begin(), from.stars.end());
      for (const std::size_t p : from.pixels) region_of[p] = touching.front();
      into.pixels.insert(into.pixels.end(), from.pixels.begin(), from.pixels.end());
      from.stars.clear();
      from.pixels.clear();
    }
  }
  std::vector<FilteredPeak> peaks;
  for (const Region& region : regions)
    for (const std::size_t star : region.stars)
      if (height(star) >= settings.threshold)
        peaks.push_back(
            {static_cast<int>(star % stride) - 1, static_cast<int>(star / stride) - 1, image.values()[star], 0});
  std::sort(peaks.begin(), peaks.end(),
            [](const FilteredPeak& a, const FilteredPeak& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return peaks;
}

}  // namespace astroid::detail
