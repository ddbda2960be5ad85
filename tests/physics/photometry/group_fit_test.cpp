// The careful fit of few stars: unbiased, at the bound, with honest errors, and never nonsense.
#include "astroid/photometry/group_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid {
namespace {

constexpr double kFwhm = 2.5;  // px
constexpr double kSky = 45.0;  // e-² per pixel, sky and readout

struct Source {
  double x, y, flux;
};

GroupPixels make_pixels(const PixelPsf& psf, const std::vector<Source>& sources, std::uint32_t seed, int side = 21) {
  GroupPixels pixels;
  pixels.box = {0, 0, side, side};
  pixels.electrons.assign(pixels.box.size(), 0.0);
  pixels.variance.assign(pixels.box.size(), kSky);
  pixels.usable.assign(pixels.box.size(), 1);
  std::vector<double> stamp(pixels.box.size());
  for (const Source& s : sources) {
    psf.integrate({s.x, s.y}, pixels.box, stamp);
    for (std::size_t k = 0; k < stamp.size(); ++k) pixels.electrons[k] += s.flux * stamp[k];
  }
  if (seed == 0) return pixels;
  const RandomStream noise = make_stream(seed, StreamId{77}, 0, 0);
  for (std::size_t k = 0; k < pixels.electrons.size(); ++k) {
    const double light = pixels.electrons[k];
    pixels.electrons[k] = poisson_at_step(noise, StepAddress{.step = 2 * k}, light) +
                          std::sqrt(kSky) * normal_at_step(noise, StepAddress{.step = 2 * k + 1});
  }
  return pixels;
}

std::vector<GroupStar> starts(const std::vector<Source>& sources, double off = 0.2) {
  std::vector<GroupStar> stars;
  for (const Source& s : sources) stars.push_back({{s.x + off, s.y - off}, 0.0});
  return stars;
}

struct Moments {
  double mean = 0.0;
  double rms = 0.0;
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v;
  m.mean /= static_cast<double>(values.size());
  for (const double v : values) m.rms += (v - m.mean) * (v - m.mean);
  m.rms = std::sqrt(m.rms / static_cast<double>(values.size() - 1));
  return m;
}

TEST(GroupFit, FindsWhatWasPutInWithoutNoise) {
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  const std::vector<Source> truth{{9.3, 10.1, 5000.0}, {12.8, 9.2, 2000.0}, {7.0, 12.9, 800.0}};
  const GroupFit fit = fit_group(make_pixels(*psf, truth, 0), *psf, starts(truth));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(fit.stars[i].flux, truth[i].flux, 1e-4 * truth[i].flux);
    EXPECT_NEAR(fit.stars[i].position.x, truth[i].x, 1e-4);
    EXPECT_NEAR(fit.stars[i].position.y, truth[i].y, 1e-4);
    EXPECT_EQ(fit.stars[i].flags, 0U);
  }
  EXPECT_NEAR(fit.background, 0.0, 1e-3);
  EXPECT_EQ(fit.outliers, 0U);
}

// Pulls of fluxes and places over many realisations.
void expect_honest(const std::vector<Source>& truth) {
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  constexpr std::uint32_t kRealisations = 200;
  std::vector<std::vector<double>> flux(truth.size());
  std::vector<std::vector<double>> place(truth.size());
  std::vector<double> background;
  for (std::uint32_t r = 1; r <= kRealisations; ++r) {
    const GroupFit fit = fit_group(make_pixels(*psf, truth, r), *psf, starts(truth));
    background.push_back(fit.background / fit.background_error);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const FittedStar& star = fit.stars[i];
      ASSERT_EQ(star.flags & measurement_flag::kMerged, 0U);
      flux[i].push_back((star.flux - truth[i].flux) / std::sqrt(star.covariance[0]));
      place[i].push_back((star.position.x - truth[i].x) / std::sqrt(star.covariance[3]));
    }
  }
  const double n = kRealisations;
  for (const auto* pulls : {&flux, &place})
    for (const auto& star : *pulls) {
      const Moments m = moments(star);
      EXPECT_NEAR(m.mean, 0.0, 4.0 / std::sqrt(n));
      EXPECT_NEAR(m.rms, 1.0, 4.0 / std::sqrt(2.0 * n));
    }
  EXPECT_NEAR(moments(background).rms, 1.0, 4.0 / std::sqrt(2.0 * n));
}

TEST(GroupFit, IsHonestAboutAStarAlone) {
  expect_honest({{10.2, 9.7, 3000.0}});
}

TEST(GroupFit, IsHonestAboutABlendOfHalfAFwhm) {
  expect_honest({{9.5, 10.0, 20000.0}, {9.5 + 0.5 * kFwhm, 10.3, 12000.0}});
}

TEST(GroupFit, StatesTheInflationThatTheFisherMatrixHas) {
  // Fluxes of two equal stars at known places: the overlap of unit Gaussians rho = exp(-d²/(4 s²)) inflates the errors
  // by 1/sqrt(1 - rho²) where the sky is all the noise. The pixel is in s².
  const double sigma = kFwhm / kFwhmPerSigma;
  const auto psf = make_gaussian_psf(sigma);
  const double wide = sigma * sigma + 1.0 / 12.0;
  for (const double d : {0.1 * kFwhm, 0.2 * kFwhm, 0.5 * kFwhm, kFwhm}) {
    const std::vector<Source> both{{15.0 - 0.5 * d, 15.0, 1e4}, {15.0 + 0.5 * d, 15.0, 1e4}};
    const std::vector<Source> one{both[0]};
    GroupFitSettings settings;
    settings.fit_background = false;
    settings.fit_positions = false;
    settings.merge_distance = 0.0;
    const auto error = [&](const std::vector<Source>& truth) {
      GroupPixels pixels = make_pixels(*psf, truth, 0, 31);
      for (double& v : pixels.variance) v = 1e5;  // a star's light adds a per cent
      return std::sqrt(fit_group(pixels, *psf, starts(truth, 0.0), settings).stars[0].covariance[0]);
    };
    const double rho = std::exp(-d * d / (4.0 * wide));
    EXPECT_NEAR(error(both) / error(one) * std::sqrt(1.0 - rho * rho), 1.0, 0.02) << d;
  }
}

TEST(GroupFit, ReportsBlendsBelowATenthOfAFwhmAsOne) {  // N17
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  for (const double d : {0.0, 0.01 * kFwhm, 0.05 * kFwhm, 0.09 * kFwhm}) {
    const std::vector<Source> truth{{10.0, 10.0, 4000.0}, {10.0 + d, 10.0, 6000.0}, {15.5, 5.1, 900.0}};
    std::vector<double> pulls;
    for (std::uint32_t r = 1; r <= 50; ++r) {
      const std::vector<GroupStar> believed{{{10.0, 10.0}, 4000.0}, {{10.0 + d, 10.0}, 6000.0}, {{15.5, 5.1}, 900.0}};
      const GroupFit fit = fit_group(make_pixels(*psf, truth, r), *psf, believed);
      EXPECT_NE(fit.stars[0].flags & measurement_flag::kMerged, 0U);
      EXPECT_NE(fit.stars[1].flags & measurement_flag::kMerged, 0U);
      EXPECT_EQ(fit.stars[2].flags & measurement_flag::kMerged, 0U);
      EXPECT_TRUE(std::isnan(fit.stars[0].flux));  // the brighter names both
      EXPECT_NEAR(fit.stars[1].position.x, 10.0 + 0.6 * d, 0.1);
      pulls.push_back((fit.stars[1].flux - 10000.0) / std::sqrt(fit.stars[1].covariance[0]));
    }
    const Moments m = moments(pulls);
    EXPECT_NEAR(m.mean, 0.0, 4.0 / std::sqrt(50.0));
    EXPECT_NEAR(m.rms, 1.0, 4.0 / std::sqrt(100.0));
  }
}

TEST(GroupFit, MergesWhatTheDataCannotTellApart) {
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  // Stars of 3 sigma at a quarter of a FWHM.
  const std::vector<Source> truth{{10.0, 10.0, 100.0}, {10.0 + 0.25 * kFwhm, 10.0, 100.0}};
  std::vector<double> sums;
  for (std::uint32_t r = 1; r <= 200; ++r) {
    const GroupFit fit = fit_group(make_pixels(*psf, truth, r), *psf, starts(truth, 0.0));
    const FittedStar& first = fit.stars[0];
    const FittedStar& second = fit.stars[1];
    if ((first.flags & measurement_flag::kMerged) != 0U) {
      EXPECT_NE(std::isnan(first.flux), std::isnan(second.flux));
      const FittedStar& sum = std::isnan(first.flux) ? second : first;
      sums.push_back((sum.flux - 200.0) / std::sqrt(sum.covariance[0]));
    } else if (std::hypot(first.position.x - second.position.x, first.position.y - second.position.y) < kFwhm) {
      EXPECT_LT(std::sqrt(first.covariance[0]), first.flux);
      EXPECT_LT(std::sqrt(second.covariance[0]), second.flux);
    }
  }
  ASSERT_GT(sums.size(), 60U);
  // Which were merged depends on their noise, so their mean is not quite that of all.
  EXPECT_NEAR(moments(sums).mean, 0.0, 0.5);
}

TEST(GroupFit, TakesNoNoticeOfACosmicRay) {
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  const std::vector<Source> truth{{10.2, 9.7, 3000.0}};
  std::vector<double> pulls;
  for (std::uint32_t r = 1; r <= 100; ++r) {
    GroupPixels pixels = make_pixels(*psf, truth, r);
    pixels.electrons[11 * 21 + 12] += 2500.0;
    const GroupFit fit = fit_group(pixels, *psf, starts(truth));
    EXPECT_NE(fit.stars[0].flags & measurement_flag::kOutlier, 0U);
    pulls.push_back((fit.stars[0].flux - 3000.0) / std::sqrt(fit.stars[0].covariance[0]));
  }
  const Moments m = moments(pulls);
  EXPECT_NEAR(m.mean, 0.0, 4.0 / std::sqrt(100.0));
  EXPECT_NEAR(m.rms, 1.0, 4.0 / std::sqrt(200.0));
}

TEST(GroupFit, FitsTheWingsOfASaturatedStar) {  // N19
  const auto psf = make_gaussian_psf(kFwhm / kFwhmPerSigma);
  const std::vector<Source> truth{{10.0, 10.0, 4e5}};
  GroupPixels pixels = make_pixels(*psf, truth, 0);
  const GroupFit whole = fit_group(pixels, *psf, starts(truth));
  double last = std::sqrt(whole.stars[0].covariance[0]);
  double place = std::sqrt(whole.stars[0].covariance[3]);
  // Bleeding along columns, symmetric; the more is masked, the wider the error.
  for (const int half : {0, 1, 2}) {
    for (int y = 10 - half - 1; y <= 10 + half + 1; ++y)
      for (int x = 10 - half; x <= 10 + half; ++x) {
        const auto k = static_cast<std::size_t>(21 * y + x);
        pixels.electrons[k] = 3e4;
        pixels.usable[k] = 0;
      }
    const GroupFit fit = fit_group(pixels, *psf, starts(truth));
    EXPECT_NEAR(fit.stars[0].flux, truth[0].flux, 1e-4 * truth[0].flux) << half;
    EXPECT_NEAR(fit.stars[0].position.x, 10.0, 1e-6);
    EXPECT_NE(fit.stars[0].flags & measurement_flag::kBadPixel, 0U);
    EXPECT_GT(std::sqrt(fit.stars[0].covariance[0]), last);
    EXPECT_GT(std::sqrt(fit.stars[0].covariance[3]), place);
    last = std::sqrt(fit.stars[0].covariance[0]);
    place = std::sqrt(fit.stars[0].covariance[3]);
  }
}

TEST(GroupFit, SaysWhyThereIsNoNumber) {
  const auto psf = make_gaussian_psf(1.0);
  GroupPixels pixels = make_pixels(*psf, {{10.0, 10.0, 1000.0}}, 3);
  const std::vector<GroupStar> stars{
      {{10.0, 10.0}, 0.0}, {{400.0, 10.0}, 100.0}, {{std::numeric_limits<double>::quiet_NaN(), 0.0}, 10.0}};
  GroupFit fit = fit_group(pixels, *psf, stars);
  EXPECT_EQ(fit.stars[0].flags, 0U);
  EXPECT_EQ(fit.stars[1].flags, measurement_flag::kOutside);
  EXPECT_EQ(fit.stars[2].flags, measurement_flag::kOutside);
  EXPECT_TRUE(std::isnan(fit.stars[1].flux));
  for (double& v : pixels.electrons) v = std::numeric_limits<double>::quiet_NaN();
  fit = fit_group(pixels, *psf, stars);
  EXPECT_TRUE(std::isnan(fit.stars[0].flux));
  EXPECT_NE(fit.stars[0].flags & measurement_flag::kBadPixel, 0U);
  fit = fit_group(GroupPixels{}, *psf, stars);
  for (const FittedStar& star : fit.stars) EXPECT_EQ(star.flags, measurement_flag::kOutside);
  EXPECT_TRUE(fit_group(pixels, *psf, std::vector<GroupStar>{}).stars.empty());
}

}  // namespace
}  // namespace astroid
