// Two-dimensional real Fourier transforms in double precision (FFTW), the same bits in every run on one machine.
#pragma once

#include <fftw3.h>

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace astroid::detail {

/// Numbers where FFTW wants them: aligned, so that one plan serves every buffer.
template <class T>
class AlignedBuffer {
 public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) { resize(size); }
  /// Contents are lost when the size changes.
  void resize(std::size_t size) {
    if (size == size_) return;
    data_.reset(static_cast<T*>(fftw_malloc(size * sizeof(T))));
    if (data_ == nullptr && size > 0) throw std::bad_alloc();
    size_ = size;
  }
  [[nodiscard]] std::span<T> span() { return {data_.get(), size_}; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_.get(); }

 private:
  struct Free {
    void operator()(T* p) const { fftw_free(p); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

/// Transforms of one size. Immutable; may be used by several threads at once, each with its own buffers.
///
/// Plans are made with FFTW_ESTIMATE, which never measures, under one mutex, and run by FFTW's new-array execute.
/// Unnormalised: backward(forward(x)) is nx ny x.
class FourierTransform {
 public:
  /// @param nx, ny  the real array has ny rows of nx, the complex one ny rows of nx / 2 + 1.
  FourierTransform(std::size_t nx, std::size_t ny);
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;
  FourierTransform(FourierTransform&&) = delete;
  FourierTransform& operator=(FourierTransform&&) = delete;
  ~FourierTransform();

  [[nodiscard]] std::size_t nx() const { return nx_; }
  [[nodiscard]] std::size_t ny() const { return ny_; }
  [[nodiscard]] std::size_t real_size() const { return nx_ * ny_; }
  [[nodiscard]] std::size_t complex_size() const { return (nx_ / 2 + 1) * ny_; }

  /// sum over r of real(r) e^(-2 pi i k r). `real` keeps its contents.
  void forward(AlignedBuffer<double>& real, AlignedBuffer<std::complex<double>>& spectrum) const;
  /// sum over k of spectrum(k) e^(+2 pi i k r). `spectrum` loses its contents.
  void backward(AlignedBuffer<std::complex<double>>& spectrum, AlignedBuffer<double>& real) const;

  /// The smallest product of powers of 2, 3, 5 and 7 that is at least n.
  static std::size_t good_size(std::size_t n);

 private:
  std::size_t nx_;
  std::size_t ny_;
  fftw_plan forward_ = nullptr;
  fftw_plan backward_ = nullptr;
};

}  // namespace astroid::detail
