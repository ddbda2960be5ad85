// Strips: the pieces in which the pixels of an exposure are worked on, small enough to stay in a core's cache.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"

namespace astroid {

/// Whole rows of one region, as they lie in the buffer of a layout: pixels `begin` … `begin + area.size()`.
struct StripPiece {
  Rectangle area;
  std::size_t begin = 0;
};

/// Consecutive pixels of a layout, `begin` … `end`: some rows of a large region, or many small windows.
struct Strip {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::vector<StripPiece> pieces;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// All pixels in one strip; its pieces are the regions.
Strip whole_strip(const PixelLayout& layout);

/// Strips of about `pixels` pixels, at least one row each, in the order of the buffer.
std::vector<Strip> make_strips(const PixelLayout& layout, std::size_t pixels);

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
  /// Those of one of its pieces, row by row.
  [[nodiscard]] std::span<T> pixels(const Strip& strip, const StripPiece& piece) {
    return pixels(strip).subspan(piece.begin - strip.begin, piece.area.size());
  }
  [[nodiscard]] ImageView<T, Unit> view(const Strip& strip, const StripPiece& piece) {
    return {pixels(strip, piece).data(), piece.area, static_cast<std::size_t>(piece.area.nx)};
  }

 private:
  std::shared_ptr<const PixelLayout> layout_;
  Plane<T, Unit> whole_;
  std::vector<T> strip_;
};

}  // namespace astroid
