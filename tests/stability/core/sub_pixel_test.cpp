// Hard cases N11, N12, N13, N29 and N40 of convolution by Fourier transform.
#include "astroid/core/sub_pixel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/test/psf_table.hpp"

namespace astroid {
namespace {

struct Picture {
  Rectangle area;
  std::vector<double> light;
  NegativeLight negative;
  [[nodiscard]] double at(int x, int y) const {
    return light[static_cast<std::size_t>((y - area.y0) * area.nx + x - area.x0)];
  }
  [[nodiscard]] double total() const { return static_cast<double>(std::accumulate(light.begin(), light.end(), 0.0L)); }
};

Picture render(const SubPixelRenderer& renderer, Rectangle area, const std::vector<StarLight>& stars) {
  Picture picture{area, std::vector<double>(area.size()), {}};
  SubPixelRenderer::Workspace workspace;
  for (const Rectangle& tile : renderer.tiles()) {
    std::vector<double> light(tile.size());
    picture.negative.add(renderer.render(tile, stars, workspace, light));
    for (int y = tile.y0; y < tile.y1(); ++y)
      for (int x = tile.x0; x < tile.x1(); ++x)
        picture.light[static_cast<std::size_t>((y - area.y0) * area.nx + x - area.x0)] =
            light[static_cast<std::size_t>((y - tile.y0) * tile.nx + x - tile.x0)];
  }
  return picture;
}

TEST(SubPixelRenderer, DoesNotWrapAround) {
  // N12: a star in the corner leaves nothing in the opposite one, nor anywhere beyond its own light.
  const Rectangle area{0, 0, 50, 37};
  const SubPixelRenderer renderer(make_gaussian_spectrum(1.0), area, {.accuracy = 1e-13});
  const Picture picture = render(renderer, area, {{.centre = {0.2, -0.3}, .electrons = 1.0}});
  for (int y = 0; y < area.ny; ++y)
    for (int x = 0; x < area.nx; ++x) {
      const bool beyond = x > 10 || y > 10;
      EXPECT_TRUE(!beyond || std::abs(picture.at(x, y)) < 1e-14) << x << " " << y << " " << picture.at(x, y);
    }
}

TEST(SubPixelRenderer, KeepsTheCentroidToOnePicopixel) {
  // N12: half a sub-pixel of misplaced centre would show as 1/2n px.
  for (const double sigma : {0.4, 1.0}) {
    const Rectangle area{0, 0, 41, 43};
    const SubPixelRenderer renderer(make_gaussian_spectrum(sigma), area, {.accuracy = 1e-14});
    for (const PixelPosition star :
         {PixelPosition{20.0, 21.0}, PixelPosition{20.3, 20.9}, PixelPosition{19.5, 21.123}}) {
      const Picture picture = render(renderer, area, {{.centre = star, .electrons = 1.0}});
      long double x_sum = 0.0L;
      long double y_sum = 0.0L;
      for (int y = 0; y < area.ny; ++y)
        for (int x = 0; x < area.nx; ++x) {
          x_sum += static_cast<long double>(picture.at(x, y)) * x;
          y_sum += static_cast<long double>(picture.at(x, y)) * y;
        }
      // The centroid of pixel integrals differs from the star's by aliases of the pixel's frequency, below e^(-2 pi²
      // sigma²) / 2 pi.
      const double alias = std::exp(-2.0 * kPi * kPi * sigma * sigma) / kPi;
      EXPECT_NEAR(static_cast<double>(x_sum), star.x, alias + 1e-12);
      EXPECT_NEAR(static_cast<double>(y_sum), star.y, alias + 1e-12);
    }
  }
}

TEST(SubPixelRenderer, KeepsTheFarFieldOfABrightStarDark) {
  // N13: single precision leaves 0.14 e- of ringing and rounding here; double 1e-7.
  const Rectangle area{0, 0, 512, 512};
  constexpr double kElectrons = 1e8;
  const SubPixelRenderer renderer(make_gaussian_spectrum(2.0), area, {.accuracy = 1e-13});
  const Picture picture = render(renderer, area, {{.centre = {255.3, 256.1}, .electrons = kElectrons}});
  double worst = 0.0;
  for (int y = 0; y < area.ny; ++y)
    for (int x = 0; x < area.nx; ++x)
      if (std::hypot(x - 255.3, y - 256.1) > 30.0) worst = std::max(worst, std::abs(picture.at(x, y)));
  RecordProperty("far_field", std::to_string(worst));
  EXPECT_LT(worst, 1e-7);
  EXPECT_NEAR(picture.total() / kElectrons, 1.0, 1e-13);
}

TEST(SubPixelRenderer, CountsAndSilencesItsRinging) {
  // N11: a map too coarse for the PSF rings. What is below zero is counted, and set to zero where the band explains it.
  const Rectangle area{0, 0, 40, 40};
  const SubPixelRenderer coarse(make_gaussian_spectrum(0.3), area, {.sub_pixels = 5});
  const std::vector<StarLight> stars = {{.centre = {20.1, 19.8}, .electrons = 1e6}};
  const Picture picture = render(coarse, area, stars);
  EXPECT_GT(coarse.predicted_error(), 1e-5);
  EXPECT_GT(picture.negative.pixels, 0);
  EXPECT_LT(picture.negative.electrons, 0.0);
  EXPECT_GE(*std::min_element(picture.light.begin(), picture.light.end()), 0.0);
  EXPECT_GE(picture.negative.electrons, -1e6 * 40.0 * coarse.predicted_error());
  // As fine as the accuracy wants it, the silencing moves nothing.
  const SubPixelRenderer fine(make_gaussian_spectrum(0.3), area, {.accuracy = 1e-7});
  const Picture good = render(fine, area, stars);
  EXPECT_GE(*std::min_element(good.light.begin(), good.light.end()), 0.0);
  EXPECT_NEAR(good.total() / 1e6, 1.0, 1e-6);
  EXPECT_GE(good.negative.electrons, -1.0);
}

TEST(SubPixelRenderer, LeavesNegativeLightOfThePsfItselfAlone) {
  // A measured PSF may be negative where its background was taken off.
  PsfTable table = test::gaussian_psf_table(1.0, 4.0, 5.0);
  table.samples.at(3, 20) = -0.001;
  const Rectangle area{0, 0, 15, 15};
  const SubPixelRenderer renderer(make_table_spectrum(table), area, {.accuracy = 1e-5});
  const Picture picture = render(renderer, area, {{.centre = {7.0, 7.0}, .electrons = 1e4}});
  EXPECT_LT(*std::min_element(picture.light.begin(), picture.light.end()), -1.0);
  EXPECT_GT(picture.negative.pixels, 0);
}

TEST(SubPixelRenderer, IsNotSlowedByDenormals) {
  // N29: wings beyond the last normal number.
  const Rectangle area{0, 0, 200, 200};
  const auto seconds = [&](double sigma) {
    const SubPixelRenderer renderer(make_gaussian_spectrum(sigma), area, {.sub_pixels = 8});
    render(renderer, area, {{.centre = {100.0, 100.0}, .electrons = 1.0}});
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 5; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      render(renderer, area, {{.centre = {100.0, 100.0}, .electrons = 1e-300}});
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return best / static_cast<double>(renderer.map_size());
  };
  constexpr double kNoise = 2.0;  // of a shared machine; denormals cost a factor of 30 or more
  EXPECT_LT(seconds(0.3), 1.5 * kNoise * seconds(1.0));
}

TEST(SubPixelRenderer, TakesAnyShapeAndAnyStar) {
  // N40, and stars that are nowhere or far away.
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Rectangle area : {Rectangle{0, 0, 1, 1}, Rectangle{0, 0, 1, 40}, Rectangle{0, 0, 40, 1}}) {
    const SubPixelRenderer renderer(make_gaussian_spectrum(0.6), area, {});
    const Picture one = render(renderer, area, {{.centre = {0.0, 0.0}, .electrons = 1.0}});
    const Picture all = render(renderer, area,
                               {{.centre = {0.0, 0.0}, .electrons = 1.0},
                                {.centre = {kNaN, 0.0}, .electrons = 1.0},
                                {.centre = {1e300, 0.0}, .electrons = 1.0},
                                {.centre = {0.0, -1e9}, .electrons = 1.0},
                                {.centre = {-30.0, 0.0}, .electrons = 1.0}});
    EXPECT_EQ(one.light, all.light);
    EXPECT_GT(one.at(0, 0), 0.3);
  }
}

TEST(SubPixelRenderer, CountsLightFromOutsideTheFrame) {
  const Rectangle area{0, 0, 20, 20};
  const SubPixelRenderer renderer(make_gaussian_spectrum(1.0), area, {.accuracy = 1e-12});
  const StarLight star{.centre = {-1.7, 10.0}, .electrons = 1.0};
  const Picture picture = render(renderer, area, {star});
  std::vector<double> exact(area.size());
  make_gaussian_psf(1.0)->integrate(star.centre, area, exact);
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(picture.light[i], exact[i], 1e-13);
}

}  // namespace
}  // namespace astroid
