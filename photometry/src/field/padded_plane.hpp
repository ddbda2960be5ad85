// A plane of floats with a margin on every side, so that stamps of stars at the edge need no clipping.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace astroid::detail {

/// Pixel (x, y) with -pad <= x < nx + pad, and y likewise; (0, 0) is the first pixel of the image.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  PaddedPlane(int nx, int ny, int pad, float value = 0.0F)
      : nx_(nx),
        ny_(ny),
        pad_(pad),
        stride_(static_cast<std::size_t>(nx + 2 * pad)),
        // A vector that begins at the last pixel may be read whole.
        values_(stride_ * static_cast<std::size_t>(ny + 2 * pad) + kReadable, value) {}

  static constexpr std::size_t kReadable = 16;

  [[nodiscard]] int nx() const { return nx_; }
  [[nodiscard]] int ny() const { return ny_; }
  [[nodiscard]] int pad() const { return pad_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] float* at(int x, int y) { return values_.data() + index(x, y); }
  [[nodiscard]] const float* at(int x, int y) const { return values_.data() + index(x, y); }
  /// The pixels of the image in row y, without the margin.
  [[nodiscard]] std::span<float> row(int y) { return {at(0, y), static_cast<std::size_t>(nx_)}; }
  [[nodiscard]] std::span<const float> row(int y) const { return {at(0, y), static_cast<std::size_t>(nx_)}; }
  [[nodiscard]] std::span<float> values() { return values_; }
  [[nodiscard]] std::span<const float> values() const { return values_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + pad_) * stride_ + static_cast<std::size_t>(x + pad_);
  }

  int nx_ = 0;
  int ny_ = 0;
  int pad_ = 0;
  std::size_t stride_ = 0;
  std::vector<float> values_;
};

}  // namespace astroid::detail
