// Sensitivity that varies within the pixel: the PSF that absorbs it, and the sub-pixel map, against adaptive
// quadrature.
#include "astroid/core/pixel_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/core/sub_pixel.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"
#include "astroid/test/sub_pixel_psf.hpp"

namespace astroid {
namespace {

constexpr Rectangle kBox{-5, -5, 11, 11};

std::vector<double> prf(const PixelPsf& psf, PixelPosition star) {
  std::vector<double> p(kBox.size());
  psf.integrate(star, kBox, p);
  return p;
}

/// The same pixels by the sub-pixel map: light of the cells times their sensitivity, or with the response in Fourier
/// space.
std::vector<double> by_cells(const SubPixelRenderer& renderer, const PixelResponse& response, PixelPosition star) {
  return test::light_by_cells(renderer, response, star, kBox);
}
std::vector<double> in_fourier_space(const SubPixelRenderer& renderer, PixelPosition star) {
  return by_cells(renderer, {}, star);
}

const std::vector<PixelPosition> kStars = {{0.0, 0.0}, {0.5, 0.5}, {0.47, -0.03}, {-0.2345, 0.31}};
const std::vector<PixelResponse> kResponses = {edge_response(10, 0.05, 0.1), edge_response(7, 0.3, 0.2),
                                               cosine_response(8, 0.2), gaussian_response(6, 0.1)};

TEST(PixelResponse, IsFoldedIntoThePsfExactly) {
  for (const double sigma : {0.4, 0.8}) {
    const auto brightness = test::smooth_brightness(test::gaussian_density(sigma));
    const std::span<const PixelResponse> two = std::span(kResponses).subspan(sigma < 0.5 ? 0 : 2, 2);
    for (const PixelResponse& response : two) {
      const auto library = make_prf_psf(make_gaussian_table(sigma, 1e-9), 1e-8, 0, response);
      const SubPixelRenderer map(make_gaussian_spectrum(sigma), kBox, {.accuracy = 1e-11, .cells = response.cells});
      const SubPixelRenderer folded(make_gaussian_spectrum(sigma), kBox, {.accuracy = 1e-11, .response = response});
      for (const PixelPosition star : kStars) {
        const auto p = prf(*library, star);
        const auto cells = by_cells(map, response, star);
        const auto fourier = in_fourier_space(folded, star);
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{1, 0}}) {
          const auto i = static_cast<std::size_t>((y - kBox.y0) * kBox.nx + x - kBox.x0);
          const auto exact =
              static_cast<double>(test::integrate_response(brightness, response, star, x, y, 1e-12L).value);
          EXPECT_NEAR(p[i], exact, 1e-8) << sigma << " " << star.x;
          EXPECT_NEAR(cells[i], exact, 1e-11) << sigma << " " << star.x;
          EXPECT_NEAR(fourier[i], exact, 1e-11) << sigma << " " << star.x;
        }
        for (std::size_t i = 0; i < p.size(); ++i) {
          EXPECT_NEAR(p[i], cells[i], 1e-8);
          EXPECT_NEAR(fourier[i], cells[i], 1e-11);
        }
      }
    }
  }
}

TEST(PixelResponse, LeavesUniformLightAlone) {
  // Uniform light is a star everywhere: the mean over all places of a star is 1 for all pixels together.
  constexpr int kPlaces = 20;
  for (const PixelResponse& response : kResponses) {
    const auto psf = make_prf_psf(make_gaussian_table(0.5, 1e-7), 1e-7, 0, response);
    double sum = 0.0;
    double least = 2.0;
    double most = 0.0;
    for (int j = 0; j < kPlaces; ++j)
      for (int i = 0; i < kPlaces; ++i) {
        const auto p = prf(*psf, {(i + 0.5) / kPlaces - 0.5, (j + 0.5) / kPlaces - 0.5});
        const double total = std::accumulate(p.begin(), p.end(), 0.0);
        sum += total;
        least = std::min(least, total);
        most = std::max(most, total);
      }
    // The mean over a lattice is exact up to the band that the response and the PSF share at its frequency.
    EXPECT_NEAR(sum / (kPlaces * kPlaces), 1.0, 1e-7);
    EXPECT_GT(most - least, 1e-4);
  }
}

TEST(PixelResponse, OfNoDepthIsTheSamePsfBitForBit) {
  const PsfTable table = test::gaussian_psf_table(0.6, 8.0, 4.0);
  const auto plain = make_prf_psf(table, 1e-6);
  for (const PixelResponse& response : {edge_response(1, 0.0, 0.1), PixelResponse{}})
    for (const PixelPosition star : kStars)
      EXPECT_EQ(prf(*plain, star), prf(*make_prf_psf(table, 1e-6, 0, response), star));
}

TEST(PixelResponse, ChangesFluxWithThePlaceAsFirstOrderSays) {
  // A star of a narrow PSF sees the sensitivity at its place.
  const PixelResponse response = cosine_response(32, 0.1);
  const double sigma = 0.05;
  const auto psf = make_prf_psf(make_gaussian_table(sigma, 1e-6), PsfAccuracy(1e-5, 1.0), 0, response);
  const double centre = 1.0 / (1.0 - 0.05) / (1.0 - 0.05);  // of a profile with mean 1 - depth/2 along each axis
  for (const double x : {0.0, 0.1, 0.25, 0.4}) {
    const auto p = prf(*psf, {x, 0.0});
    const double total = std::accumulate(p.begin(), p.end(), 0.0);
    // Blurred by the PSF: the cosine loses e^(-2 pi² sigma²) of its swing.
    const double swing = std::exp(-2.0 * kPi * kPi * sigma * sigma);
    const auto profile = [&](double u) { return 1.0 - 0.05 * (1.0 - swing * std::cos(2.0 * kPi * u)); };
    EXPECT_NEAR(total, centre * profile(x) * profile(0.0), 5e-4) << x;  // cells of 1/32 px: 1 % of the swing
  }
}

TEST(GaussianTable, IsAsFineAsTheAccuracyNeeds) {
  for (const double sigma : {0.3, 0.6, 1.5}) {
    for (const double accuracy : {1e-6, 1e-8}) {
      const auto library = make_prf_psf(make_gaussian_table(sigma, accuracy), 0.1 * accuracy);
      const auto exact = make_gaussian_psf(sigma);
      double worst = 0.0;
      for (const PixelPosition star : kStars) {
        std::vector<double> e(kBox.size());
        exact->integrate(star, kBox, e);
        const auto p = prf(*library, star);
        for (std::size_t i = 0; i < p.size(); ++i) worst = std::max(worst, std::abs(p[i] - e[i]));
      }
      EXPECT_LT(worst, 1.1 * accuracy) << sigma;
      EXPECT_GT(worst, 1e-4 * accuracy) << sigma;  // and not much finer, which would cost memory
    }
  }
}

}  // namespace
}  // namespace astroid
