#include "astroid/sim/power_law_field.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "astroid/core/image.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "fourier.hpp"

namespace astroid {

namespace {

constexpr int kLongestSide = 8192;      // of a grid, so that it takes half a gigabyte at most
constexpr std::size_t kSideBySide = 8;  // transforms whose numbers stay in a second-level cache together

/// Frequencies that a real row of n values needs.
std::size_t half(int n) {
  return static_cast<std::size_t>(n / 2 + 1);
}

}  // namespace

PowerLawField::PowerLawField(const RandomStream& stream, int columns, int rows, double exponent, double rms) {
  cell_ = (std::max(columns, rows) + kLongestSide - 1) / kLongestSide;
  const int used_columns = (columns + cell_ - 1) / cell_;
  const int used_rows = (rows + cell_ - 1) / cell_;
  const int nx = smooth_size(used_columns);
  const int ny = smooth_size(used_rows);
  stride_ = 2 * half(nx);
  values_.resize(stride_ * static_cast<std::size_t>(ny));
  draw(stream, nx, ny, exponent);
  transform_columns(nx, ny);
  transform_rows(nx, ny);
  normalise(used_columns, used_rows, rms);
}

void PowerLawField::draw(const RandomStream& stream, int columns, int rows, double exponent) {
  const std::size_t width = half(columns);
  for (int ky = 0; ky < rows; ++ky) {
    const Rectangle area{0, ky, static_cast<int>(width), 1};
    const std::span<float> real = std::span(values_).subspan(static_cast<std::size_t>(ky) * stride_, width);
    const std::span<float> imaginary =
        std::span(values_).subspan(static_cast<std::size_t>(ky) * stride_ + width, width);
    pixel_normals(stream, {.areas = {&area, 1}, .draw = 0}, real);
    pixel_normals(stream, {.areas = {&area, 1}, .draw = 1}, imaginary);
    const double fy = static_cast<double>(std::min(ky, rows - ky)) / rows;
    for (std::size_t kx = 0; kx < width; ++kx) {
      const double fx = static_cast<double>(kx) / columns;
      const double square = fx * fx + fy * fy;
      const auto amplitude = static_cast<float>(square > 0.0 ? det::exp(-0.25 * exponent * det::log(square)) : 0.0);
      real[kx] *= amplitude;
      imaginary[kx] *= amplitude;
    }
  }
}

void PowerLawField::transform_columns(int columns, int rows) {
  const std::size_t width = half(columns);
  const auto height = static_cast<std::size_t>(rows);
  FourierTransform transform(rows, kSideBySide);
  std::vector<double> real(height * kSideBySide);
  std::vector<double> imaginary(height * kSideBySide);
  for (std::size_t begin = 0; begin < width; begin += kSideBySide) {
    const std::size_t count = std::min(kSideBySide, width - begin);
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t b = 0; b < count; ++b) {
        real[y * kSideBySide + b] = static_cast<double>(values_[y * stride_ + begin + b]);
        imaginary[y * kSideBySide + b] = static_cast<double>(values_[y * stride_ + width + begin + b]);
      }
    transform.transform(real, imaginary);
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t b = 0; b < count; ++b) {
        values_[y * stride_ + begin + b] = static_cast<float>(real[y * kSideBySide + b]);
        values_[y * stride_ + width + begin + b] = static_cast<float>(imaginary[y * kSideBySide + b]);
      }
  }
}

/// Two real rows make one complex sequence: the first as its real part, the second as its imaginary part.
void PowerLawField::transform_rows(int columns, int rows) {
  const std::size_t width = half(columns);
  const auto length = static_cast<std::size_t>(columns);
  FourierTransform transform(columns, kSideBySide);
  std::vector<double> real(length * kSideBySide);
  std::vector<double> imaginary(length * kSideBySide);
  for (int begin = 0; begin < rows; begin += 2 * static_cast<int>(kSideBySide)) {
    const std::size_t pairs = std::min(kSideBySide, static_cast<std::size_t>((rows - begin) / 2));
    for (std::size_t b = 0; b < pairs; ++b) {
      const float* const first = values_.data() + (static_cast<std::size_t>(begin) + 2 * b) * stride_;
      const float* const second = first + stride_;
      for (std::size_t k = 0; k < width; ++k) {
        double a_real = static_cast<double>(first[k]);
        double a_imaginary = static_cast<double>(first[width + k]);
        double b_real = static_cast<double>(second[k]);
        double b_imaginary = static_cast<double>(second[width + k]);
        const bool is_alone = k == 0 || 2 * k == length;
        if (is_alone) {
          // A frequency that is its own negative has no imaginary part, and all its power in the real one.
          a_real *= std::numbers::sqrt2;
          b_real *= std::numbers::sqrt2;
          a_imaginary = 0.0;
          b_imaginary = 0.0;
        }
        real[k * kSideBySide + b] = a_real - b_imaginary;
        imaginary[k * kSideBySide + b] = a_imaginary + b_real;
        if (is_alone) continue;
        real[(length - k) * kSideBySide + b] = a_real + b_imaginary;
        imaginary[(length - k) * kSideBySide + b] = b_real - a_imaginary;
      }
    }
    transform.transform(real, imaginary);
    for (std::size_t b = 0; b < pairs; ++b) {
      float* const first = values_.data() + (static_cast<std::size_t>(begin) + 2 * b) * stride_;
      float* const second = first + stride_;
      for (std::size_t x = 0; x < length; ++x) {
        first[x] = static_cast<float>(real[x * kSideBySide + b]);
        second[x] = static_cast<float>(imaginary[x * kSideBySide + b]);
      }
    }
  }
}

void PowerLawField::normalise(int columns, int rows, double rms) {
  const auto width = static_cast<std::size_t>(columns);
  const double n = static_cast<double>(columns) * rows;
  const auto row = [&](int y) { return std::span(values_).subspan(static_cast<std::size_t>(y) * stride_, width); };
  double mean = 0.0;
  for (int y = 0; y < rows; ++y) {
    double sum = 0.0;
    for (const float value : row(y)) sum += static_cast<double>(value);
    mean += sum / n;
  }
  double variance = 0.0;
  for (int y = 0; y < rows; ++y) {
    double sum = 0.0;
    for (const float value : row(y)) sum += (static_cast<double>(value) - mean) * (static_cast<double>(value) - mean);
    variance += sum / n;
  }
  const double factor = variance > 0.0 ? rms / det::sqrt(variance) : 0.0;
  for (int y = 0; y < rows; ++y)
    for (float& value : row(y)) value = static_cast<float>((static_cast<double>(value) - mean) * factor);
}

}  // namespace astroid
