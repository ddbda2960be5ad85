#include "detect/peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace astroid::detail {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Saddle {
  float height;
  std::uint32_t first, second;  // basins, first < second
};

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

// Pixels above the footprint, each led uphill to its peak. Of equal pixels the one before in the order of rows is the
// higher.
struct Basins {
  std::vector<std::uint32_t> pixels;    // above the footprint, in the order of rows
  std::vector<std::uint32_t> of_pixel;  // shape of the image's values; kNone below the footprint
  std::vector<std::uint32_t> peak;      // index of its pixel
  std::vector<std::uint32_t> area;
};

Basins make_basins(const SmoothImage& image, float footprint) {
  const float* v = image.values().data();
  const auto stride = static_cast<std::ptrdiff_t>(image.stride());
  Basins basins;
  basins.of_pixel.assign(image.values().size(), kNone);
  // First the index of the highest neighbour, or its own for a peak.
  std::vector<std::uint32_t>& up = basins.of_pixel;
  for (int y = 0; y < image.ny(); ++y) {
    const std::size_t first = image.index(0, y);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(image.nx()); ++i) {
      const float value = v[i];
      if (!(value > footprint)) continue;
      const auto p = static_cast<std::ptrdiff_t>(i);
      float best = value;
      std::ptrdiff_t to = p;
      // Neighbours before win ties, those after need to be higher.
      for (const std::ptrdiff_t q : {p - stride - 1, p - stride, p - stride + 1, p - 1})
        if (v[q] > best || (v[q] == best && to == p)) {
          best = v[q];
          to = q;
        }
      for (const std::ptrdiff_t q : {p + 1, p + stride - 1, p + stride, p + stride + 1})
        if (v[q] > best) {
          best = v[q];
          to = q;
        }
      up[i] = static_cast<std::uint32_t>(to);
      basins.pixels.push_back(static_cast<std::uint32_t>(i));
    }
  }
  // Peaks are numbered in the order of rows; then every path is followed once.
  constexpr std::uint32_t kLabel = 0x80000000U;
  for (const std::uint32_t i : basins.pixels) {
    if (up[i] != i) continue;
    up[i] = kLabel | static_cast<std::uint32_t>(basins.peak.size());
    basins.peak.push_back(i);
  }
  basins.area.assign(basins.peak.size(), 0);
  for (const std::uint32_t i : basins.pixels) {
    std::uint32_t top = up[i];
    while ((top & kLabel) == 0U) top = up[top];
    // Shorten the path for those that come after.
    std::uint32_t at = i;
    while ((up[at] & kLabel) == 0U) {
      const std::uint32_t next = up[at];
      up[at] = top;
      at = next;
    }
    ++basins.area[top & ~kLabel];
  }
  for (const std::uint32_t i : basins.pixels) up[i] &= ~kLabel;
  return basins;
}

// The highest saddle between every two basins that touch, the highest first.
std::vector<Saddle> find_saddles(const SmoothImage& image, const Basins& basins) {
  const float* v = image.values().data();
  const auto stride = static_cast<std::ptrdiff_t>(image.stride());
  const std::vector<std::uint32_t>& basin = basins.of_pixel;
  // Each basin's saddles with basins of higher number, linked.
  std::vector<Saddle> saddles;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> head(basins.peak.size(), kNone);
  for (const std::uint32_t i : basins.pixels) {
    const std::uint32_t a = basin[i];
    const auto p = static_cast<std::ptrdiff_t>(i);
    for (const std::ptrdiff_t q : {p + 1, p + stride - 1, p + stride, p + stride + 1}) {
      const std::uint32_t b = basin[static_cast<std::size_t>(q)];
      if (b == a || b == kNone) continue;
      const float height = std::min(v[p], v[q]);
      const std::uint32_t low = std::min(a, b);
      const std::uint32_t high = std::max(a, b);
      std::uint32_t s = head[low];
      while (s != kNone && saddles[s].second != high) s = next[s];
      if (s == kNone) {
        next.push_back(head[low]);
        head[low] = static_cast<std::uint32_t>(saddles.size());
        saddles.push_back({height, low, high});
      } else {
        saddles[s].height = std::max(saddles[s].height, height);
      }
    }
  }
  std::sort(saddles.begin(), saddles.end(), [](const Saddle& a, const Saddle& b) {
    if (a.height != b.height) return a.height > b.height;
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  return saddles;
}

bool stands_out(const PeakSettings& settings, double lower, double higher, double saddle) {
  const double noise = std::sqrt(1.0 + settings.photon_noise * std::max(0.0, saddle));
  return lower >= settings.threshold &&
         lower - saddle >= std::max(settings.prominence * noise, settings.contrast * higher);
}

}  // namespace

std::vector<FilteredPeak> find_peaks(const SmoothImage& image, const PeakSettings& settings) {
  const Basins basins = make_basins(image, static_cast<float>(settings.footprint));
  const std::size_t n = basins.peak.size();
  const auto height_of = [&](std::uint32_t basin) { return image.values()[basins.peak[basin]]; };
  // Basins of one star; its root is its highest peak.
  std::vector<std::uint32_t> star(n);
  for (std::uint32_t i = 0; i < n; ++i) star[i] = i;
  // Basins that are connected above the saddle, and the stars in them, linked from the highest to the last.
  std::vector<std::uint32_t> connected = star;
  std::vector<std::uint32_t> last = star;
  std::vector<std::uint32_t> next(n, kNone);
  const auto is_higher = [&](std::uint32_t a, std::uint32_t b) {
    return height_of(a) > height_of(b) || (height_of(a) == height_of(b) && a < b);
  };
  for (const Saddle& saddle : find_saddles(image, basins)) {
    const std::uint32_t a = find_root(connected, saddle.first);
    const std::uint32_t b = find_root(connected, saddle.second);
    if (a == b) continue;
    const bool first_higher = is_higher(a, b);
    const std::uint32_t higher = first_higher ? a : b;
    const std::uint32_t lower = first_higher ? b : a;
    if (stands_out(settings, static_cast<double>(height_of(lower)), static_cast<double>(height_of(higher)),
                   static_cast<double>(saddle.height))) {
      next[last[higher]] = lower;
      last[higher] = last[lower];
    } else {
      // What does not stand out is part of the star that it touches.
      std::uint32_t beside = find_root(star, first_higher ? saddle.first : saddle.second);
      for (std::uint32_t s = lower; s != kNone; s = next[s]) {
        const std::uint32_t part = find_root(star, s);
        if (part == beside) continue;
        const bool part_higher = is_higher(part, beside);
        star[part_higher ? beside : part] = part_higher ? part : beside;
        if (part_higher) beside = part;
      }
    }
    connected[lower] = higher;
  }
  std::vector<std::uint32_t> area(n, 0);
  for (std::uint32_t i = 0; i < n; ++i) area[find_root(star, i)] += basins.area[i];
  std::vector<FilteredPeak> peaks;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (star[i] != i || !(static_cast<double>(height_of(i)) >= settings.threshold)) continue;
    const std::size_t row = basins.peak[i] / image.stride();
    const std::size_t column = basins.peak[i] % image.stride();
    peaks.push_back({static_cast<int>(column) - 1, static_cast<int>(row) - 1, height_of(i), static_cast<int>(area[i])});
  }
  return peaks;
}

}  // namespace astroid::detail
