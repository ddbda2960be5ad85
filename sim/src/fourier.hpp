// Fourier transforms that give the same bits on every processor, unlike FFTW's, for what is drawn once and kept.
#pragma once

#include <cstddef>
#include <vector>

namespace astroid {

/// The smallest even number of at least `size` with no prime factor above 5.
int smooth_size(int size);

/// Discrete transforms of many sequences of one length side by side.
class FourierTransform {
 public:
  /// @param size   smooth: no prime factor above 5.  @param batch  sequences transformed at once.
  FourierTransform(int size, std::size_t batch);

  /// real + i imaginary: element k of sequence b is at [k * batch + b]. In place, exp(-2 pi i j k / size), no factor.
  /// @accuracy relative 1e-15 log(size) of the largest element (test: FourierTransform.IsTheDefinition).
  /// @complexity O(size log size), some 25 complex products an element.
  void transform(std::vector<double>& real, std::vector<double>& imaginary);

 private:
  template <int Radix>
  void pass(std::size_t length, std::size_t stride);
  int size_;
  std::size_t batch_;
  std::vector<int> factors_;
  std::vector<double> cosine_;
  std::vector<double> sine_;
  std::vector<double> in_real_, in_imaginary_, out_real_, out_imaginary_;
};

}  // namespace astroid
