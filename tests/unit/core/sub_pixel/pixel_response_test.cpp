#include "astroid/core/pixel_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

namespace astroid {
namespace {

std::vector<PixelResponse> responses() {
  return {edge_response(8, 0.05, 0.05), edge_response(20, 0.05, 0.05), edge_response(5, 0.3, 0.21),
          cosine_response(8, 0.1),      gaussian_response(8, 0.1),     gaussian_response(1, 0.1)};
}

TEST(PixelResponse, HasMeanOne) {
  for (const PixelResponse& response : responses()) {
    const long double sum = std::accumulate(response.sensitivity.begin(), response.sensitivity.end(), 0.0L);
    EXPECT_NEAR(static_cast<double>(sum) / static_cast<double>(response.sensitivity.size()), 1.0, 1e-15);
  }
}

TEST(PixelResponse, OfNoDepthIsUniform) {
  for (const PixelResponse& response :
       {edge_response(8, 0.0, 0.05), edge_response(8, 0.05, 0.0), cosine_response(4, 0.0), gaussian_response(4, 0.0)}) {
    EXPECT_TRUE(response.is_uniform());
    EXPECT_EQ(response.depth(), 0.0);
  }
  EXPECT_FALSE(edge_response(8, 0.05, 0.05).is_uniform());
}

TEST(PixelResponse, OfAnEdgeHasTheWidthAndDepthAsked) {
  // 20 cells of 0.05 px: the border is the outermost ring of cells.
  const PixelResponse response = edge_response(20, 0.05, 0.05);
  const double inside = response.at(10, 10);
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(response.at(i, 0) / inside, 0.95, 1e-14);
    EXPECT_NEAR(response.at(19, i) / inside, 0.95, 1e-14);
  }
  EXPECT_NEAR(response.at(1, 1) / inside, 1.0, 1e-14);
  // The mean of a border of width w and depth d is 1 - d (1 - (1 - 2 w)²).
  EXPECT_NEAR(1.0 / inside, 1.0 - 0.05 * (1.0 - 0.9 * 0.9), 1e-14);
}

TEST(PixelResponse, IsSymmetric) {
  for (const PixelResponse& r : responses())
    for (int j = 0; j < r.cells; ++j)
      for (int i = 0; i < r.cells; ++i) {
        EXPECT_NEAR(r.at(i, j), r.at(r.cells - 1 - i, j), 1e-15);
        EXPECT_NEAR(r.at(i, j), r.at(j, i), 1e-15);
      }
}

TEST(PixelResponse, FallsFromTheCentreToTheEdgeAsItsProfile) {
  const PixelResponse cosine = cosine_response(64, 0.1);
  EXPECT_NEAR(cosine.at(0, 32) / cosine.at(32, 32), 0.9, 2e-3);
  EXPECT_NEAR(cosine.at(0, 0) / cosine.at(32, 32), 0.81, 4e-3);
  const PixelResponse gaussian = gaussian_response(64, 0.1);
  EXPECT_NEAR(gaussian.at(0, 32) / gaussian.at(32, 32), 0.9, 4e-3);
  EXPECT_NEAR(gaussian.at(0, 0) / gaussian.at(32, 32), 0.81, 6e-3);
}

TEST(PixelResponse, HasTheTransformOfItsCells) {
  for (const PixelResponse& r : responses()) {
    const std::vector<double> kx = {0.0, 0.4, 1.0, 2.7};
    const std::vector<double> ky = {-1.3, 0.0, 0.9};
    std::vector<std::complex<double>> values(kx.size() * ky.size());
    sample_response(r, kx, ky, values);
    EXPECT_NEAR(std::abs(values[kx.size()] - 1.0), 0.0, 1e-15);
    constexpr int kFine = 240;  // midpoint rule, h²/24 (2 pi k)² of the flux
    for (std::size_t q = 0; q < ky.size(); ++q)
      for (std::size_t i = 0; i < kx.size(); ++i) {
        std::complex<double> sum;
        for (int v = 0; v < kFine; ++v)
          for (int u = 0; u < kFine; ++u) {
            const double x = (u + 0.5) / kFine - 0.5;
            const double y = (v + 0.5) / kFine - 0.5;
            sum += r.at(u * r.cells / kFine, v * r.cells / kFine) *
                   std::polar(1.0 / (kFine * kFine), -2.0 * std::acos(-1.0) * (kx[i] * x + ky[q] * y));
          }
        EXPECT_NEAR(std::abs(values[q * kx.size() + i] - sum), 0.0, 3e-4) << kx[i] << " " << ky[q];
      }
  }
}

}  // namespace
}  // namespace astroid
