#include "sub_pixel/fourier_transform.hpp"

#include <mutex>
#include <new>

#include "astroid/core/error.hpp"

namespace astroid::detail {

namespace {

// FFTW's planner is not thread-safe.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* as_fftw(std::complex<double>* p) {
  return reinterpret_cast<fftw_complex*>(p);  // NOLINT: FFTW states that the two are the same in memory
}

}  // namespace

FourierTransform::FourierTransform(std::size_t nx, std::size_t ny) : nx_(nx), ny_(ny) {
  AlignedBuffer<double> real(real_size());
  AlignedBuffer<std::complex<double>> spectrum(complex_size());
  const auto columns = static_cast<int>(nx);
  const auto rows = static_cast<int>(ny);
  const std::lock_guard lock(planner());
  forward_ =
      fftw_plan_dft_r2c_2d(rows, columns, real.data(), as_fftw(spectrum.data()), FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  backward_ = fftw_plan_dft_c2r_2d(rows, columns, as_fftw(spectrum.data()), real.data(), FFTW_ESTIMATE);
  if (forward_ == nullptr || backward_ == nullptr) throw BugError("FFTW has no plan for a transform of this size");
}

FourierTransform::~FourierTransform() {
  const std::lock_guard lock(planner());
  fftw_destroy_plan(forward_);
  fftw_destroy_plan(backward_);
}

void FourierTransform::forward(AlignedBuffer<double>& real, AlignedBuffer<std::complex<double>>& spectrum) const {
  ASTROID_CHECK_EQ(real.size(), real_size());
  ASTROID_CHECK_EQ(spectrum.size(), complex_size());
  fftw_execute_dft_r2c(forward_, real.data(), as_fftw(spectrum.data()));
}

void FourierTransform::backward(AlignedBuffer<std::complex<double>>& spectrum, AlignedBuffer<double>& real) const {
  ASTROID_CHECK_EQ(real.size(), real_size());
  ASTROID_CHECK_EQ(spectrum.size(), complex_size());
  fftw_execute_dft_c2r(backward_, as_fftw(spectrum.data()), real.data());
}

std::size_t FourierTransform::good_size(std::size_t n) {
  for (;; ++n) {
    std::size_t rest = n;
    for (const std::size_t prime : {2U, 3U, 5U, 7U})
      while (rest % prime == 0 && rest > 0) rest /= prime;
    if (rest <= 1) return n;
  }
}

}  // namespace astroid::detail
