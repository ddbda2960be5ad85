// The oracle of all renderers against closed forms, and its own statement of its error.
#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

long double exact_axis(long double sigma, long double a, long double b) {
  const long double scale = 1.0L / (std::sqrt(2.0L) * sigma);
  return 0.5L * (std::erf(b * scale) - std::erf(a * scale));
}

TEST(Oracle, IntegratesAGaussianAndStatesItsError) {
  for (const long double sigma : {0.1L, 0.3L, 1.0L, 3.0L}) {
    const auto brightness = test::smooth_brightness(test::gaussian_density(sigma));
    const PixelPosition star{0.31, -0.12};
    for (const int n : {1, 3}) {
      const auto area = test::area_of({-1, 0, n, n});
      const auto integral = test::integrate_area(brightness, star, area, 1e-14L);
      const long double exact =
          exact_axis(sigma, area.x0 - 0.31L, area.x1 - 0.31L) * exact_axis(sigma, area.y0 + 0.12L, area.y1 + 0.12L);
      EXPECT_LE(std::abs(integral.value - exact), integral.error + 1e-17L) << static_cast<double>(sigma);
      EXPECT_LT(static_cast<double>(integral.error), 1.2e-14);
    }
  }
}

TEST(Oracle, OfATableKeepsTheFluxOfEverySample) {
  PsfTable table = test::gaussian_psf_table(0.7, 4.0, 3.0);
  table.samples.at(3, 5) = 0.02;
  long double total = 0.0L;
  for (const double sample : table.samples.pixels()) total += static_cast<long double>(sample);
  const auto brightness = test::table_brightness(table);
  for (const auto& [i, j] : {std::pair{3, 5}, std::pair{0, 0}, std::pair{12, 11}, std::pair{23, 4}}) {
    const test::Area sample{
        brightness.x_breaks[static_cast<std::size_t>(i)], brightness.x_breaks[static_cast<std::size_t>(i) + 1],
        brightness.y_breaks[static_cast<std::size_t>(j)], brightness.y_breaks[static_cast<std::size_t>(j) + 1]};
    const auto flux = test::integrate_area(brightness, {0.0, 0.0}, sample, 1e-14L);
    EXPECT_NEAR(static_cast<double>(flux.value - static_cast<long double>(table.samples.at(i, j)) / total), 0.0, 1e-15);
  }
}

TEST(Oracle, OfATableIsWhatThePhaseLibraryHasAtItsPhases) {
  const PsfTable table = test::sampled_gaussian_psf_table(0.7, 5.0, 3.0);
  const auto brightness = test::table_brightness(table);
  const auto psf = make_prf_psf(table, 1.0, 8);
  for (const PixelPosition star : {PixelPosition{0.0, 0.0}, PixelPosition{0.125, 0.75}}) {
    const Rectangle box{-2, -2, 5, 5};
    std::vector<double> p(box.size());
    psf->integrate(star, box, p);
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x) {
        const auto exact = test::integrate_area(brightness, star, test::area_of({x, y, 1, 1}), 1e-14L);
        EXPECT_NEAR(p[static_cast<std::size_t>((y - box.y0) * box.nx + x - box.x0)], static_cast<double>(exact.value),
                    2e-15);
      }
  }
}

TEST(Oracle, WeighsCellsWithTheResponse) {
  const auto brightness = test::smooth_brightness(test::gaussian_density(0.5L));
  const PixelPosition star{0.2, 0.1};
  const auto whole = test::integrate_area(brightness, star, test::area_of({0, 0, 1, 1}), 1e-14L);
  const auto uniform = test::integrate_response(brightness, {}, star, 0, 0, 1e-14L);
  EXPECT_NEAR(static_cast<double>(uniform.value), static_cast<double>(whole.value), 1e-16);
  // A pixel that sees with its left half only.
  const PixelResponse half{.cells = 2, .sensitivity = {2.0, 0.0, 2.0, 0.0}};
  const auto left = test::integrate_response(brightness, half, star, 0, 0, 1e-14L);
  const long double exact = 2.0L * exact_axis(0.5L, -0.7L, -0.2L) * exact_axis(0.5L, -0.6L, 0.4L);
  EXPECT_NEAR(static_cast<double>(left.value), static_cast<double>(exact), 1e-15);
}

}  // namespace
}  // namespace astroid
