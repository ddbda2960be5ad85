// Laws that every PSF renderer obeys: one body, every renderer.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"
#include "astroid/test/sub_pixel_psf.hpp"

namespace astroid {
namespace {

struct Renderer {
  std::string name;
  std::function<std::shared_ptr<const PixelPsf>()> make;
  test::Density density;  // what it renders
  double tolerance;       // of one pixel, relative to the star's flux
  int reach;              // px, half-width that holds the flux to `closure`
  double closure;         // |1 - sum| over that box
};

class EveryRenderer : public testing::TestWithParam<Renderer> {
 protected:
  std::shared_ptr<const PixelPsf> psf_ = GetParam().make();

  [[nodiscard]] std::vector<double> render(PixelPosition star, Rectangle box) const {
    std::vector<double> fractions(box.size());
    psf_->integrate(star, box, fractions);
    return fractions;
  }
};

const std::vector<PixelPosition> kStars = {{0.0, 0.0}, {0.5, 0.5}, {0.499, -0.25}, {-0.1234567, 0.31}, {7.77, -3.2}};

TEST_P(EveryRenderer, AgreesWithQuadrature) {
  for (const PixelPosition star : kStars) {
    const Rectangle box{static_cast<int>(std::floor(star.x)) - 2, static_cast<int>(std::floor(star.y)) - 2, 6, 6};
    const auto p = render(star, box);
    for (int j = 0; j < box.ny; ++j) {
      for (int i = 0; i < box.nx; ++i) {
        const long double exact = test::integrate_pixel(GetParam().density, star, box.x0 + i, box.y0 + j, 1e-13L);
        EXPECT_NEAR(p[static_cast<std::size_t>(j * box.nx + i)], static_cast<double>(exact), GetParam().tolerance)
            << star.x << ", " << star.y << " pixel " << i << ", " << j;
      }
    }
  }
}

TEST_P(EveryRenderer, PutsTheWholeFluxSomewhere) {
  const int reach = GetParam().reach;
  for (const PixelPosition star : kStars) {
    const Rectangle box{static_cast<int>(star.x) - reach, static_cast<int>(star.y) - reach, 2 * reach + 1,
                        2 * reach + 1};
    const auto p = render(star, box);
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, GetParam().closure);
  }
}

TEST_P(EveryRenderer, GivesAPixelTheSameBitsInEveryBox) {
  const PixelPosition star{3.3, -1.7};
  const Rectangle large{-70, -71, 140, 139};  // wider than any block that a renderer might work in
  const auto whole = render(star, large);
  for (const Rectangle box : {Rectangle{3, -2, 1, 1}, Rectangle{0, -4, 7, 6}, Rectangle{-3, -8, 70, 13}}) {
    const auto part = render(star, box);
    for (int j = 0; j < box.ny; ++j) {
      for (int i = 0; i < box.nx; ++i) {
        const int at = (box.y0 + j - large.y0) * large.nx + box.x0 + i - large.x0;
        EXPECT_EQ(part[static_cast<std::size_t>(j * box.nx + i)], whole[static_cast<std::size_t>(at)]);
      }
    }
  }
}

TEST_P(EveryRenderer, SplitsAStarOnTheFrameEdgeWithoutLoss) {
  const int reach = GetParam().reach;
  const PixelPosition star{-0.7, 12.45};
  const auto outside = render(star, {-reach - 1, 12 - reach, reach + 1, 2 * reach + 1});
  const auto inside = render(star, {0, 12 - reach, reach + 1, 2 * reach + 1});
  const double out = std::accumulate(outside.begin(), outside.end(), 0.0);
  const double in = std::accumulate(inside.begin(), inside.end(), 0.0);
  EXPECT_GT(out, in);
  EXPECT_GT(in, 0.1);
  EXPECT_NEAR(in + out, 1.0, GetParam().closure);
}

TEST_P(EveryRenderer, MovesWithTheStarByWholePixels) {
  // Bit for bit where the shifted position is exact, as here: 0.34375 = 11/32.
  const auto here = render({0.34375, -0.15625}, {-4, -4, 9, 9});
  const auto there = render({1234.34375, -77.15625}, {1230, -81, 9, 9});
  EXPECT_EQ(here, there);
}

TEST_P(EveryRenderer, IsContinuousAcrossPixelsAndPhases) {
  constexpr double kStep = 1e-9;     // px
  constexpr double kSteepest = 5.0;  // per px, above the slope of any pixel of any renderer here
  const Rectangle box{-4, -4, 9, 9};
  for (const double x : {-0.5, 0.0, 0.5, 0.125, 0.25, 0.03125}) {
    const auto left = render({x - kStep, 0.1}, box);
    const auto right = render({x + kStep, 0.1}, box);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 2.0 * kStep * kSteepest);
  }
}

TEST_P(EveryRenderer, KnowsItsOwnSlope) {
  constexpr double kStep = 1e-4;  // px; the third derivative leaves h^2 / 6 of it
  const Rectangle box{-3, -3, 7, 7};
  for (const PixelPosition star : {PixelPosition{0.11, -0.23}, PixelPosition{-0.41, 0.37}}) {
    std::vector<double> dpdx(box.size());
    std::vector<double> dpdy(box.size());
    psf_->integrate_gradient(star, box, dpdx, dpdy);
    if (std::isnan(dpdx[0])) return;  // a renderer without gradients
    const auto east = render({star.x + kStep, star.y}, box);
    const auto west = render({star.x - kStep, star.y}, box);
    const auto north = render({star.x, star.y + kStep}, box);
    const auto south = render({star.x, star.y - kStep}, box);
    for (std::size_t i = 0; i < dpdx.size(); ++i) {
      EXPECT_NEAR(dpdx[i], (east[i] - west[i]) / (2.0 * kStep), 3e-7);
      EXPECT_NEAR(dpdy[i], (north[i] - south[i]) / (2.0 * kStep), 3e-7);
    }
  }
}

TEST_P(EveryRenderer, KeepsItsPromiseOfLostFlux) {
  for (const double lost : {1e-2, 1e-4, 1e-6}) {
    const double r = psf_->stamp_half_width(lost);
    for (const PixelPosition star : kStars) {
      const auto p = render(star, stamp_box(star, r));
      EXPECT_LT(1.0 - std::accumulate(p.begin(), p.end(), 0.0), lost + GetParam().closure);
    }
  }
}

Renderer gaussian(double sigma) {
  return {"Gaussian" + std::to_string(static_cast<int>(100.0 * sigma)),
          [sigma] { return make_gaussian_psf(sigma); },
          test::gaussian_density(sigma),
          1e-15,
          40,
          1e-15};
}

// A table whose samples hold the Gaussian's exact flux, so that only the spline and the phases are between it and the
// density. At 32 samples per pixel they leave 2.9e-8 of the star's flux in the brightest pixel.
Renderer table(double sigma) {
  return {"Table" + std::to_string(static_cast<int>(100.0 * sigma)),
          [sigma] { return make_prf_psf(test::gaussian_psf_table(sigma, 32.0, 7.0 * sigma), 1e-8); },
          test::gaussian_density(sigma),
          6e-8,
          20,
          1e-10};
}

Renderer sub_pixel(double sigma) {
  return {"SubPixel" + std::to_string(static_cast<int>(100.0 * sigma)),
          [sigma] { return test::make_sub_pixel_psf(make_gaussian_spectrum(sigma), 24, {.accuracy = 1e-12}); },
          test::gaussian_density(sigma),
          1e-13,
          24,
          1e-12};
}

INSTANTIATE_TEST_SUITE_P(Psf, EveryRenderer,
                         testing::Values(gaussian(0.3), gaussian(0.6), gaussian(1.0), table(0.6), table(1.0),
                                         sub_pixel(0.3), sub_pixel(0.6), sub_pixel(1.0)),
                         [](const auto& renderer) { return renderer.param.name; });

}  // namespace
}  // namespace astroid
