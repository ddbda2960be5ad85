// Images with a unit. Pixel coordinates everywhere: 0-based, the centre of the first pixel is (0, 0), x = column, y =
// row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// A rectangle of detector pixels: columns x0 … x0+nx-1, rows y0 … y0+ny-1. x0 and y0 may be negative.
struct Rectangle {
  int x0 = 0;
  int y0 = 0;
  int nx = 0;
  int ny = 0;
  [[nodiscard]] constexpr int x1() const { return x0 + nx; }  ///< one past the last column
  [[nodiscard]] constexpr int y1() const { return y0 + ny; }  ///< one past the last row
  [[nodiscard]] constexpr bool empty() const { return nx <= 0 || ny <= 0; }
  [[nodiscard]] constexpr bool contains(int x, int y) const { return x >= x0 && x < x1() && y >= y0 && y < y1(); }
  [[nodiscard]] constexpr std::size_t size() const {
    return empty() ? 0 : static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  }
  friend constexpr bool operator==(const Rectangle&, const Rectangle&) = default;
};

/// The common part of two rectangles; empty() when there is none.
constexpr Rectangle intersect(const Rectangle& a, const Rectangle& b) {
  const int x0 = a.x0 > b.x0 ? a.x0 : b.x0;
  const int y0 = a.y0 > b.y0 ? a.y0 : b.y0;
  const int x1 = a.x1() < b.x1() ? a.x1() : b.x1();
  const int y1 = a.y1() < b.y1() ? a.y1() : b.y1();
  return {x0, y0, x1 > x0 ? x1 - x0 : 0, y1 > y0 ? y1 - y0 : 0};
}

/// A window on pixels that somebody else owns. Deep const: an ImageView<const T, Unit> cannot change them.
/// Rows are addressed by detector row y, and row(y)[i] is detector column area().x0 + i.
template <class T, class Unit>
class ImageView {
 public:
  ImageView(T* data, Rectangle area, std::size_t stride) : data_(data), area_(area), stride_(stride) {}
  /// A view on mutable pixels converts to one on constant pixels.
  operator ImageView<const T, Unit>() const { return {data_, area_, stride_}; }  // NOLINT(google-explicit-constructor)

  [[nodiscard]] const Rectangle& area() const { return area_; }
  [[nodiscard]] int nx() const { return area_.nx; }
  [[nodiscard]] int ny() const { return area_.ny; }
  [[nodiscard]] std::span<T> row(int y) const {
    return {data_ + static_cast<std::size_t>(y - area_.y0) * stride_, static_cast<std::size_t>(area_.nx)};
  }
  [[nodiscard]] T& at(int x, int y) const { return row(y)[static_cast<std::size_t>(x - area_.x0)]; }
  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }

 private:
  T* data_;
  Rectangle area_;
  std::size_t stride_;
};

/// An owned rectangle of pixels, row by row, zero at birth. Moves; copies only by clone().
template <class T, class Unit>
class Image {
 public:
  Image() = default;
  explicit Image(Rectangle area) : area_(area), pixels_(area.size()) {}
  Image(int nx, int ny) : Image(Rectangle{0, 0, nx, ny}) {}
  Image(Image&&) noexcept = default;
  Image& operator=(Image&&) noexcept = default;
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
  ~Image() = default;

  [[nodiscard]] Image clone() const {
    Image copy(area_);
    copy.pixels_ = pixels_;
    return copy;
  }
  [[nodiscard]] const Rectangle& area() const { return area_; }
  [[nodiscard]] int nx() const { return area_.nx; }
  [[nodiscard]] int ny() const { return area_.ny; }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] ImageView<T, Unit> view() { return {pixels_.data(), area_, static_cast<std::size_t>(area_.nx)}; }
  [[nodiscard]] ImageView<const T, Unit> view() const {
    return {pixels_.data(), area_, static_cast<std::size_t>(area_.nx)};
  }
  [[nodiscard]] std::span<T> row(int y) { return view().row(y); }
  [[nodiscard]] std::span<const T> row(int y) const { return view().row(y); }
  [[nodiscard]] T& at(int x, int y) { return view().at(x, y); }
  [[nodiscard]] const T& at(int x, int y) const { return view().at(x, y); }
  [[nodiscard]] std::span<T> pixels() { return pixels_; }
  [[nodiscard]] std::span<const T> pixels() const { return pixels_; }

 private:
  Rectangle area_;
  std::vector<T> pixels_;
};

/// Which pixels of a detector are computed: the full frame, one sub-field, or one window per target, and the reference
/// pixels (prescan, overscan) that are read with them.
/// The pixels of all regions lie one after the other in one buffer; `offset(r)` is where region r begins.
class PixelLayout {
 public:
  /// @param exposed    regions of light-sensitive pixels, which come first.
  /// @param reference  regions of reference pixels: columns below 0 or beyond the last, rows beyond the last.
  explicit PixelLayout(std::vector<Rectangle> exposed, const std::vector<Rectangle>& reference = {})
      : regions_(std::move(exposed)), exposed_(regions_.size()) {
    regions_.insert(regions_.end(), reference.begin(), reference.end());
    offsets_.reserve(regions_.size() + 1);
    offsets_.push_back(0);
    for (const Rectangle& region : regions_) offsets_.push_back(offsets_.back() + region.size());
  }
  [[nodiscard]] std::span<const Rectangle> regions() const { return regions_; }
  [[nodiscard]] std::span<const Rectangle> exposed_regions() const { return std::span(regions_).first(exposed_); }
  [[nodiscard]] std::span<const Rectangle> reference_regions() const { return std::span(regions_).subspan(exposed_); }
  [[nodiscard]] std::size_t offset(std::size_t region) const { return offsets_[region]; }
  [[nodiscard]] std::size_t size() const { return offsets_.back(); }
  /// Index in the buffer of pixel (x, y) of region r, which must contain it.
  [[nodiscard]] std::size_t index(std::size_t region, int x, int y) const {
    const Rectangle& a = regions_[region];
    return offsets_[region] + static_cast<std::size_t>(y - a.y0) * static_cast<std::size_t>(a.nx) +
           static_cast<std::size_t>(x - a.x0);
  }

 private:
  std::vector<Rectangle> regions_;
  std::size_t exposed_;
  std::vector<std::size_t> offsets_;
};

/// One value per pixel of a layout, in one contiguous buffer. Changes unit only by being moved through a function that
/// returns another plane. Moves; never copied implicitly.
template <class T, class Unit>
class Plane {
 public:
  Plane() = default;
  explicit Plane(std::shared_ptr<const PixelLayout> layout) : layout_(std::move(layout)), pixels_(layout_->size()) {}
  Plane(Plane&&) noexcept = default;
  Plane& operator=(Plane&&) noexcept = default;
  Plane(const Plane&) = delete;
  Plane& operator=(const Plane&) = delete;
  ~Plane() = default;

  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] const PixelLayout& layout() const { return *layout_; }
  [[nodiscard]] const std::shared_ptr<const PixelLayout>& shared_layout() const { return layout_; }
  [[nodiscard]] ImageView<T, Unit> view(std::size_t region) {
    const Rectangle& a = layout_->regions()[region];
    return {pixels_.data() + layout_->offset(region), a, static_cast<std::size_t>(a.nx)};
  }
  [[nodiscard]] ImageView<const T, Unit> view(std::size_t region) const {
    const Rectangle& a = layout_->regions()[region];
    return {pixels_.data() + layout_->offset(region), a, static_cast<std::size_t>(a.nx)};
  }
  [[nodiscard]] std::span<T> pixels() { return pixels_; }
  [[nodiscard]] std::span<const T> pixels() const { return pixels_; }

 private:
  std::shared_ptr<const PixelLayout> layout_;
  std::vector<T> pixels_;
};

}  // namespace astroid
