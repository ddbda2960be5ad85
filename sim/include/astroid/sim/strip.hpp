// Strips: the pieces in which the pixels of an exposure are worked on, small enough to stay in a core's cache.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"

namespace astroid {

/// Consecutive pixels of a layout, `begin` … `end`: some rows of a large region, or many small windows. They are the
/// pixels of its areas, one after the other, each row by row.
struct Strip {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::vector<Rectangle> areas;          ///< whole rows of one region each
  std::vector<std::size_t> area_begins;  ///< where each begins in the buffer of the layout
  bool exposed = true;                   ///< to light; reference pixels lie in strips of their own
  [[nodiscard]] std::size_t size() const { return end - begin; }
  void add(const Rectangle& area) {
    areas.push_back(area);
    area_begins.push_back(end);
    end += area.size();
  }
};

/// All pixels in one strip; its areas are the regions, the exposed ones first.
Strip whole_strip(const PixelLayout& layout);
/// All pixels that light falls on.
Strip exposed_strip(const PixelLayout& layout);

/// Pixels of a strip of an exposure: its planes of doubles, 128 KiB each, stay in a second-level cache together.
inline constexpr std::size_t kStripPixels = 16384;

/// Strips of about `pixels` pixels, at least one row each, in the order of the buffer.
/// @param band_rows  areas do not reach across multiples of so many rows of the detector; 0: wherever they like.
std::vector<Strip> make_strips(const PixelLayout& layout, std::size_t pixels, int band_rows = 0);

/// A plane of which, as a rule, only the strip at work exists: what one effect hands to the next need not travel
/// through memory. Where an effect or an observer wants all of it, it is a whole plane.
template <class T, class Unit>
class StripPlane {
 public:
  StripPlane() = default;
  /// @param longest  pixels of the longest strip that will be asked for.
  StripPlane(std::shared_ptr<const PixelLayout> layout, std::size_t longest)
      : layout_(std::move(layout)), strip_(longest) {}

  /// Keeps all pixels from now on.
  void make_whole() {
    if (is_whole()) return;
    whole_ = Plane<T, Unit>(layout_);
    strip_ = {};
  }
  [[nodiscard]] bool is_whole() const { return !whole_.empty() || layout_->size() == 0; }
  /// @throws BugError unless make_whole() was called.
  [[nodiscard]] Plane<T, Unit>& whole() {
    ASTROID_CHECK_EQ(is_whole(), true);
    return whole_;
  }
  [[nodiscard]] const Plane<T, Unit>& whole() const {
    ASTROID_CHECK_EQ(is_whole(), true);
    return whole_;
  }

  /// The pixels of a strip. Unless the plane is whole, they replace those of the strip before.
  [[nodiscard]] std::span<T> pixels(const Strip& strip) {
    if (is_whole()) return whole_.pixels().subspan(strip.begin, strip.size());
    ASTROID_CHECK_LE(strip.size(), strip_.size());
    return std::span(strip_).first(strip.size());
  }
  /// One of its areas.
  [[nodiscard]] ImageView<T, Unit> view(const Strip& strip, std::size_t area) {
    const std::span<T> all = pixels(strip);
    const Rectangle& rectangle = strip.areas[area];
    return {all.data() + (strip.area_begins[area] - strip.begin), rectangle, static_cast<std::size_t>(rectangle.nx)};
  }

 private:
  std::shared_ptr<const PixelLayout> layout_;
  Plane<T, Unit> whole_;
  std::vector<T> strip_;
};

}  // namespace astroid
