#include "astroid/core/effective_psf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/fits_writer.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

double share(double from, double to, double sigma) {
  return 0.5 * (std::erf(to / sigma / std::sqrt(2.0)) - std::erf(from / sigma / std::sqrt(2.0)));
}

// A Gaussian integrated over pixels; terms after the first widen it to the right and to the top.
struct Grid {
  int samples, half, order;
};

EffectivePsf gaussian(double sigma, const Grid& grid) {
  const int samples = grid.samples;
  const int half = grid.half;
  EffectivePsf psf;
  psf.samples_per_pixel = samples;
  psf.half = half;
  psf.order = grid.order;
  psf.field_centre = {100.0, 50.0};
  psf.field_scale = {100.0, 50.0};
  const auto plane = [&](double s) {
    std::vector<double> values;
    for (int j = -half; j <= half; ++j)
      for (int i = -half; i <= half; ++i) {
        const double x = static_cast<double>(i) / samples;
        const double y = static_cast<double>(j) / samples;
        values.push_back(share(x - 0.5, x + 0.5, s) * share(y - 0.5, y + 0.5, s));
      }
    return values;
  };
  const std::vector<double> first = plane(sigma);
  const std::vector<double> wide = plane(1.1 * sigma);
  for (std::size_t k = 0; k < psf.terms(); ++k) {
    std::vector<double> term(first);
    if (k > 0)
      for (std::size_t i = 0; i < term.size(); ++i) term[i] = (wide[i] - first[i]) / static_cast<double>(k);
    spline_coefficients_of(term, psf.side());
    psf.coefficients.insert(psf.coefficients.end(), term.begin(), term.end());
  }
  return psf;
}

// Largest error of a Gaussian of 1 px on a grid of that many samples per pixel, of its peak.
double error_of(int samples) {
  constexpr double kSigma = 1.0;
  const auto psf = make_effective_psf(gaussian(kSigma, {samples, 7 * samples, 0}));
  const double peak = share(-0.5, 0.5, kSigma) * share(-0.5, 0.5, kSigma);
  const Rectangle box{-5, -5, 11, 11};
  std::vector<double> values(box.size());
  double largest = 0.0;
  for (const double x : {-0.5, -0.31, -0.125, 0.0, 0.17, 0.25, 0.49}) {
    for (const double y : {-0.25, 0.0, 0.125, 0.4}) {
      psf->integrate({x, y}, box, values);
      std::size_t k = 0;
      for (int j = box.y0; j < box.y1(); ++j)
        for (int i = box.x0; i < box.x1(); ++i, ++k) {
          const double truth = share(i - 0.5 - x, i + 0.5 - x, kSigma) * share(j - 0.5 - y, j + 0.5 - y, kSigma);
          largest = std::max(largest, std::abs(values[k] - truth) / peak);
        }
    }
  }
  return largest;
}

TEST(EffectivePsf, IsAGaussianToAPerMilleOfItsPeakAndConvergesWithTheFourthPowerOfItsStep) {
  const double coarse = error_of(2);
  EXPECT_LT(coarse, 1e-3);
  const double fine = error_of(4);
  // A smooth function is 2^4 nearer on half the step; near its start the series has higher terms.
  EXPECT_LT(fine, coarse / 14.0);
  EXPECT_GT(fine, coarse / 40.0);
}

TEST(EffectivePsf, HasTheSlopesOfItsValues) {
  for (const int order : {0, 1, 2}) {
    const auto psf = make_effective_psf(gaussian(0.9, {3, 18, order}));
    const Rectangle box{120, 60, 9, 7};
    const PixelPosition place{123.83, 62.41};
    std::vector<double> above(box.size());
    std::vector<double> below(box.size());
    std::vector<double> dx(box.size());
    std::vector<double> dy(box.size());
    psf->integrate_gradient(place, box, dx, dy);
    constexpr double kStep = 1e-5;
    psf->integrate({place.x + kStep, place.y}, box, above);
    psf->integrate({place.x - kStep, place.y}, box, below);
    for (std::size_t i = 0; i < dx.size(); ++i) EXPECT_NEAR(dx[i], (above[i] - below[i]) / (2.0 * kStep), 1e-8);
    psf->integrate({place.x, place.y + kStep}, box, above);
    psf->integrate({place.x, place.y - kStep}, box, below);
    for (std::size_t i = 0; i < dy.size(); ++i) EXPECT_NEAR(dy[i], (above[i] - below[i]) / (2.0 * kStep), 1e-8);
  }
}

TEST(EffectivePsf, HasTheSameBitsInAnyBox) {
  const auto psf = make_effective_psf(gaussian(0.8, {2, 10, 2}));
  const Rectangle large{20, 30, 25, 21};
  std::vector<double> all(large.size());
  const PixelPosition place{31.4, 40.9};
  psf->integrate(place, large, all);
  const Rectangle small{28, 37, 6, 9};
  std::vector<double> part(small.size());
  psf->integrate(place, small, part);
  std::size_t k = 0;
  for (int y = small.y0; y < small.y1(); ++y)
    for (int x = small.x0; x < small.x1(); ++x)
      EXPECT_EQ(part[k++], all[static_cast<std::size_t>((y - large.y0) * large.nx + x - large.x0)]);
}

TEST(EffectivePsf, IsZeroFarAwayAndUnknownNowhere) {
  const auto psf = make_effective_psf(gaussian(0.8, {2, 10, 1}));
  const Rectangle box{0, 0, 5, 5};
  std::vector<double> values(box.size(), 7.0);
  for (const PixelPosition place : {PixelPosition{1e4, 2.0}, PixelPosition{2.0, -40.0}, PixelPosition{1e300, 1e300}}) {
    psf->integrate(place, box, values);
    EXPECT_TRUE(std::ranges::all_of(values, [](double v) { return v == 0.0; }));
  }
  psf->integrate({std::numeric_limits<double>::quiet_NaN(), 0.0}, box, values);
  EXPECT_TRUE(std::ranges::all_of(values, [](double v) { return std::isnan(v); }));
}

TEST(EffectivePsf, VariesAsItsPolynomialsAndIsHeldBeyondTheField) {
  const EffectivePsf psf = gaussian(0.8, {2, 10, 2});
  double phi[6];
  field_terms(psf, {150.0, 25.0}, phi);
  const double expected[6]{1.0, 0.5, -0.5, 0.25, -0.25, 0.25};
  for (int k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(phi[k], expected[k]);
  field_terms(psf, {1e6, -1e6}, phi);
  const double held[6]{1.0, 1.0, -1.0, 1.0, -1.0, 1.0};
  for (int k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(phi[k], held[k]);
}

TEST(EffectivePsf, HasSplinesThatGoBackToTheirValues) {
  std::vector<double> values(81);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i * i));
  std::vector<double> again(values);
  spline_coefficients_of(again, 9);
  spline_values_of(again, 9);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(again[i], values[i], 1e-13);
}

TEST(EffectivePsf, HasWeightsThatAddUpToOne) {
  for (const double t : {0.0, 1e-9, 0.2, 0.5, 0.77, 1.0 - 1e-12}) {
    const CubicWeights w = cubic_weights(t);
    EXPECT_NEAR(std::accumulate(std::begin(w.weight), std::end(w.weight), 0.0), 1.0, 1e-15);
    EXPECT_NEAR(std::accumulate(std::begin(w.slope), std::end(w.slope), 0.0), 0.0, 1e-15);
  }
}

TEST(EffectivePsf, RefusesWhatIsNoPsf) {
  EffectivePsf psf = gaussian(0.8, {2, 10, 1});
  psf.coefficients.pop_back();
  EXPECT_THROW(make_effective_psf(psf), InputError);
  psf = gaussian(0.8, {2, 10, 1});
  psf.coefficients[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_effective_psf(psf), InputError);
  psf = gaussian(0.8, {2, 10, 1});
  psf.field_scale.x = 0.0;
  EXPECT_THROW(make_effective_psf(psf), InputError);
}

TEST(EffectivePsfFile, GivesBackThePsf) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "psf.fits";
  for (const int order : {0, 2}) {
    const EffectivePsf psf = gaussian(0.8, {3, 9, order});
    write_effective_psf(file, psf);
    EXPECT_TRUE(is_effective_psf(file));
    const EffectivePsf again = read_effective_psf(file);
    EXPECT_EQ(again.samples_per_pixel, psf.samples_per_pixel);
    EXPECT_EQ(again.half, psf.half);
    EXPECT_EQ(again.order, psf.order);
    EXPECT_EQ(again.field_centre.x, psf.field_centre.x);
    EXPECT_EQ(again.field_scale.y, psf.field_scale.y);
    ASSERT_EQ(again.coefficients.size(), psf.coefficients.size());
    const double peak = *std::ranges::max_element(psf.coefficients);
    for (std::size_t i = 0; i < psf.coefficients.size(); ++i)
      EXPECT_NEAR(again.coefficients[i], psf.coefficients[i], 1e-6 * peak);
    std::filesystem::remove(file);
  }
}

TEST(EffectivePsfFile, IsToldFromOtherImages) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "image.fits";
  FitsWriter fits(file);
  (void)fits.begin_image(FitsNumber::kFloat32, {4, 4});
  fits.write_plane(Image<float, unit::Adu>(Rectangle{0, 0, 4, 4}));
  fits.commit();
  EXPECT_FALSE(is_effective_psf(file));
  EXPECT_THROW(read_effective_psf(file), InputError);
}

}  // namespace
}  // namespace astroid
