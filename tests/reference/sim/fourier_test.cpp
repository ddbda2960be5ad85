// The Fourier transform against its definition.
#include "fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace astroid {
namespace {

TEST(FourierTransform, IsTheDefinition) {
  for (const int size : {1, 2, 3, 4, 5, 6, 8, 12, 30, 64, 90, 125, 144, 1000}) {
    for (const std::size_t batch : {1U, 3U}) {
      const auto n = static_cast<std::size_t>(size);
      std::vector<double> real(n * batch);
      std::vector<double> imaginary(n * batch);
      for (std::size_t i = 0; i < real.size(); ++i) {
        real[i] = std::sin(1.7 * static_cast<double>(i * i));
        imaginary[i] = std::cos(0.3 * static_cast<double>(i * i) + 0.2);
      }
      const std::vector<double> a = real;
      const std::vector<double> b = imaginary;
      FourierTransform(size, batch).transform(real, imaginary);
      for (std::size_t q = 0; q < batch; ++q)
        for (std::size_t k = 0; k < n; ++k) {
          std::complex<long double> sum = 0.0L;
          for (std::size_t j = 0; j < n; ++j)
            sum += std::complex<long double>(a[j * batch + q], b[j * batch + q]) *
                   std::polar(1.0L, -2.0L * std::numbers::pi_v<long double> * static_cast<long double>(j * k % n) /
                                        static_cast<long double>(n));
          ASSERT_NEAR(real[k * batch + q], static_cast<double>(sum.real()), 2e-13) << size << ' ' << k;
          ASSERT_NEAR(imaginary[k * batch + q], static_cast<double>(sum.imag()), 2e-13) << size << ' ' << k;
        }
    }
  }
}

TEST(FourierTransform, KnowsSmoothSizes) {
  EXPECT_EQ(smooth_size(1), 2);
  EXPECT_EQ(smooth_size(7), 8);
  EXPECT_EQ(smooth_size(480), 480);
  EXPECT_EQ(smooth_size(4510), 4608);
  EXPECT_EQ(smooth_size(2049), 2160);
}

}  // namespace
}  // namespace astroid
