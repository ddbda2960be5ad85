#include "fourier.hpp"

#include <array>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr std::array<int, 4> kRadices{4, 2, 3, 5};

/// The radices of a smooth number; what is left after them is 1.
std::vector<int> factors_of(int size) {
  std::vector<int> factors;
  for (const int radix : kRadices)
    for (; size % radix == 0; size /= radix) factors.push_back(radix);
  if (size != 1) factors.clear();
  return factors;
}

}  // namespace

int smooth_size(int size) {
  int smooth = size < 2 ? 2 : size + size % 2;
  while (factors_of(smooth).empty()) smooth += 2;
  return smooth;
}

FourierTransform::FourierTransform(int size, std::size_t batch)
    : size_(size), batch_(batch), factors_(factors_of(size)) {
  ASTROID_CHECK_EQ(size == 1 || !factors_.empty(), true);
  for (int k = 0; k < size; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / size;
    cosine_.push_back(det::cos(angle));
    sine_.push_back(-det::sin(angle));
  }
}

/// One pass of Stockham's algorithm: sequences of `length`, `stride` of them interleaved, become Radix times as many.
template <int Radix>
void FourierTransform::pass(std::size_t length, std::size_t stride) {
  const auto size = static_cast<std::size_t>(size_);
  const std::size_t part = length / Radix;
  const std::size_t run = stride * batch_;
  const std::size_t turn = size / length;  // of the twiddle of p = 1, in steps of the table
  const std::size_t corner = size / Radix;
  for (std::size_t p = 0; p < part; ++p) {
    std::array<const double*, Radix> real{};
    std::array<const double*, Radix> imaginary{};
    for (std::size_t j = 0; j < Radix; ++j) {
      real[j] = in_real_.data() + run * (p + part * j);
      imaginary[j] = in_imaginary_.data() + run * (p + part * j);
    }
    for (std::size_t k = 0; k < Radix; ++k) {
      std::array<double, Radix> c{};
      std::array<double, Radix> s{};
      for (std::size_t j = 0; j < Radix; ++j) {
        const std::size_t angle = (p * k * turn + j * k % Radix * corner) % size;
        c[j] = cosine_[angle];
        s[j] = sine_[angle];
      }
      double* const out_real = out_real_.data() + run * (Radix * p + k);
      double* const out_imaginary = out_imaginary_.data() + run * (Radix * p + k);
      for (std::size_t q = 0; q < run; ++q) {
        double a = 0.0;
        double b = 0.0;
        for (std::size_t j = 0; j < Radix; ++j) {
          a += c[j] * real[j][q] - s[j] * imaginary[j][q];
          b += c[j] * imaginary[j][q] + s[j] * real[j][q];
        }
        out_real[q] = a;
        out_imaginary[q] = b;
      }
    }
  }
}

void FourierTransform::transform(std::vector<double>& real, std::vector<double>& imaginary) {
  const std::size_t all = static_cast<std::size_t>(size_) * batch_;
  ASTROID_CHECK_EQ(real.size(), all);
  ASTROID_CHECK_EQ(imaginary.size(), all);
  in_real_.swap(real);
  in_imaginary_.swap(imaginary);
  out_real_.resize(all);
  out_imaginary_.resize(all);
  auto length = static_cast<std::size_t>(size_);
  std::size_t stride = 1;
  for (const int radix : factors_) {
    switch (radix) {
      case 2:
        pass<2>(length, stride);
        break;
      case 3:
        pass<3>(length, stride);
        break;
      case 4:
        pass<4>(length, stride);
        break;
      default:
        pass<5>(length, stride);
        break;
    }
    length /= static_cast<std::size_t>(radix);
    stride *= static_cast<std::size_t>(radix);
    in_real_.swap(out_real_);
    in_imaginary_.swap(out_imaginary_);
  }
  real.swap(in_real_);
  imaginary.swap(in_imaginary_);
  in_real_.resize(all);
  in_imaginary_.resize(all);
}

}  // namespace astroid
