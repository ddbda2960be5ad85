// The fast ways of adding a star to an image against the PSF's own integrals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"
#include "gaussian_profiles.hpp"

namespace astroid {
namespace {

double value(const detail::GaussianProfiles::Axis& axis, std::size_t stride, int pixel) {
  double sum = 0.0;
  for (std::size_t k = 0; k < detail::GaussianProfiles::kTerms; ++k)
    sum += axis.weights[k] * axis.rows[k * stride + static_cast<std::size_t>(pixel - axis.first)];
  return sum;
}

TEST(GaussianProfiles, AreTheIntegrals) {
  for (const double sigma : {0.15, 0.3, 0.6, 0.65, 1.0, 1.7, 4.0}) {
    const detail::GaussianProfiles profiles(sigma);
    for (int i = 0; i < 997; ++i) {
      const double x = 3.0 + i / 997.0 * 1.02;
      const detail::GaussianProfiles::Axis axis = profiles.axis(x, 0.0);
      for (int pixel = axis.first; pixel < axis.first + axis.size; ++pixel) {
        const double scale = 1.0 / (std::sqrt(2.0) * sigma);
        const double exact = 0.5 * (std::erfc((pixel - 0.5 - x) * scale) - std::erfc((pixel + 0.5 - x) * scale));
        ASSERT_NEAR(value(axis, profiles.stride(), pixel), exact, 1e-13) << sigma << ' ' << x << ' ' << pixel;
      }
    }
  }
}

TEST(GaussianProfiles, AreBroadenedLikeAWiderGaussian) {
  constexpr double kSigma = 0.6;
  const detail::GaussianProfiles profiles(kSigma);
  for (const double variance : {1e-6, 1e-4, 2.5e-3}) {
    const double wide = std::sqrt(kSigma * kSigma + variance);
    // The first neglected order: variance^3 / 48 times the sixth derivative.
    const double allowed = 1e-12 + std::pow(variance / (kSigma * kSigma), 3) / 48.0 * 15.0;
    for (int i = 0; i < 101; ++i) {
      const double x = i / 101.0;
      const detail::GaussianProfiles::Axis axis = profiles.axis(x, variance);
      for (int pixel = axis.first; pixel < axis.first + axis.size; ++pixel) {
        const double scale = 1.0 / (std::sqrt(2.0) * wide);
        const double exact = 0.5 * (std::erfc((pixel - 0.5 - x) * scale) - std::erfc((pixel + 0.5 - x) * scale));
        // Terms beyond the fifth power of the phase are missing from the second derivative as well.
        ASSERT_NEAR(value(axis, profiles.stride(), pixel), exact, allowed + 1e-8 * variance) << variance << ' ' << x;
      }
    }
  }
}

class AddStar : public testing::TestWithParam<int> {
 protected:
  static std::shared_ptr<const PixelPsf> psf() {
    switch (GetParam()) {
      case 0:
        return make_gaussian_psf(0.6);
      case 1:
        return make_gaussian_psf(2.3);
      case 2:
        return make_gaussian_psf(0.05);  // too narrow for the table
      default:
        return make_prf_psf(test::sampled_gaussian_psf_table(0.8, 8.0, 4.0), 1e-7);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Psfs, AddStar, testing::Range(0, 4));

/// A star at a random place in or near an image of 40 x 40 px that begins at (-7, 5).
StarLight random_star(int i) {
  const RandomStream stream = make_stream(11, StreamId{1}, 0, 0);
  const auto u = [&](std::uint32_t axis) {
    return uniform_at_step(stream, {.step = static_cast<std::uint64_t>(i), .axis = axis});
  };
  return {.centre = {50.0 * u(0) - 12.0, 50.0 * u(1)}, .electrons = 1e5 * u(2), .half_width = 6.0 * u(3)};
}
constexpr Rectangle kArea{-7, 5, 40, 40};

TEST_P(AddStar, AddsTheFractionsOfIntegrate) {
  const auto star_psf = psf();
  std::vector<double> scratch;
  for (int i = 0; i < 300; ++i) {
    Image<double, unit::ExpectedElectrons> image(kArea);
    StarLight star = random_star(i);
    if (i % 3 == 0) {
      star.broadened = true;
      star.motion = {1e-4, i % 2 == 0 ? 5e-5 : 0.0, 2e-4};
    }
    star_psf->add_star(star, image.view(), scratch);
    const Rectangle box = intersect(stamp_box(star.centre, star.half_width), kArea);
    std::vector<double> fractions(box.size());
    if (star.broadened) {
      star_psf->integrate_broadened(star.centre, star.motion, box, fractions, scratch);
    } else {
      star_psf->integrate(star.centre, box, fractions);
    }
    for (int y = kArea.y0; y < kArea.y1(); ++y)
      for (int x = kArea.x0; x < kArea.x1(); ++x) {
        const double expected =
            box.contains(x, y) ? fractions[static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(box.nx) +
                                           static_cast<std::size_t>(x - box.x0)]
                               : 0.0;
        // Broadening is to second order in both, by different terms of the fourth.
        const double allowed = star.broadened ? 1e-6 : 2e-13;
        ASSERT_NEAR(image.at(x, y) / star.electrons, expected, allowed) << i << ' ' << x << ' ' << y;
      }
  }
}

TEST_P(AddStar, GivesAPixelTheSameBitsInAnyPartOfTheImage) {
  const auto star_psf = psf();
  std::vector<double> scratch;
  Image<double, unit::ExpectedElectrons> whole(kArea);
  for (int i = 0; i < 200; ++i) star_psf->add_star(random_star(i), whole.view(), scratch);
  for (const Rectangle part : {Rectangle{-7, 5, 40, 3}, Rectangle{-7, 8, 40, 1}, Rectangle{0, 10, 6, 6},
                               Rectangle{32, 44, 1, 1}, Rectangle{-7, 20, 17, 25}}) {
    Image<double, unit::ExpectedElectrons> image(part);
    for (int i = 0; i < 200; ++i) star_psf->add_star(random_star(i), image.view(), scratch);
    for (int y = part.y0; y < part.y1(); ++y)
      for (int x = part.x0; x < part.x1(); ++x) ASSERT_EQ(image.at(x, y), whole.at(x, y)) << x << ' ' << y;
  }
}

TEST_P(AddStar, LeavesTheImageAloneForAStarThatIsNowhere) {
  const auto star_psf = psf();
  std::vector<double> scratch;
  Image<double, unit::ExpectedElectrons> image(kArea);
  for (const double nowhere : {std::nan(""), HUGE_VAL, 1e12, -1e12, 1e300}) {
    star_psf->add_star({.centre = {nowhere, 10.0}, .electrons = 1e5, .half_width = 4.0}, image.view(), scratch);
    star_psf->add_star({.centre = {10.0, nowhere}, .electrons = 1e5, .half_width = 4.0}, image.view(), scratch);
  }
  for (const double pixel : image.pixels()) ASSERT_EQ(pixel, 0.0);
}

}  // namespace
}  // namespace astroid
