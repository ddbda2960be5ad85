// Stated errors against the scatter of many noise realisations: pulls have width 1 and mean 0.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "astroid/core/distributions.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr std::uint32_t kRealisations = 2500;
constexpr int kSide = 64;

// Poisson electrons, readout noise, rounding to whole counts.
Frame realisation(const std::shared_ptr<const PixelLayout>& layout, const test::GroundScene& scene,
                  std::span<const double> expected, std::uint32_t exposure) {
  const RandomStream photons = make_stream(11, StreamId{1}, 0, 0);
  const RandomStream readout = make_stream(11, StreamId{2}, 0, 0);
  Frame frame = test::empty_frame(layout, scene.gain, scene.bias);
  frame.header.readout_noise = Electrons(scene.noise.readout);
  std::vector<double> electrons(kSide);
  std::vector<double> noise(kSide);
  for (int y = 0; y < kSide; ++y) {
    poisson_row(photons, {0, y, exposure, 0, 0}, expected.subspan(static_cast<std::size_t>(y) * kSide, kSide),
                electrons);
    normal_row(readout, {0, y, exposure, 0, 0}, noise);
    for (std::size_t x = 0; x < kSide; ++x)
      frame.pixels.view(0).row(y)[x] = static_cast<float>(
          std::floor((electrons[x] + scene.noise.readout * noise[x]) / scene.gain.value() + scene.bias.value() + 0.5));
  }
  return frame;
}

test::GroundScene crowded_scene() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.8);
  scene.gain = Gain(20.0);
  scene.bias = Adu(1000.0);
  scene.noise = {600.0, 30.0, 20.0 / std::sqrt(12.0)};
  scene.add_target({20.3, 20.6}, 4e5);
  scene.add_target({23.1, 21.0}, 5e4);
  scene.add_target({40.5, 22.5}, 2e4);
  scene.add_target({41.2, 40.9}, 8e3);
  scene.add_target({22.0, 43.8}, 3e3);
  scene.add_star({24.9, 44.5}, 2e5);
  scene.add_target({0.4, 31.0}, 3e4);
  return scene;
}

// Sums of (measured - true) / error.
struct Pull {
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  void add(double pull) {
    sum += pull;
    squares += pull * pull;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double width() const { return std::sqrt(squares / count - mean() * mean()); }
};

TEST(EstimatorErrors, HavePullWidthOneAndNoBias) {
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(kSide, kSide);
  const std::vector<double> expected = test::expected_electrons(*layout, scene);
  struct Method {
    PhotometryMethod method;
    BackgroundMethod background;
  };
  for (const auto& [method, background] : {Method{PhotometryMethod::kMask, BackgroundMethod::kLocal},
                                           Method{PhotometryMethod::kAperture, BackgroundMethod::kKnown},
                                           Method{PhotometryMethod::kWeighted, BackgroundMethod::kLocal},
                                           Method{PhotometryMethod::kPsf, BackgroundMethod::kKnown},
                                           Method{PhotometryMethod::kPsf, BackgroundMethod::kLocal}}) {
    PhotometrySettings settings;
    settings.method = method;
    settings.background = background;
    const auto estimators = build_estimators(*layout, scene.model(), settings);
    const EstimatorSet set(estimators, scene.gain, scene.bias);
    std::vector<Pull> pulls(set.size());
    std::vector<double> flux(set.size());
    std::vector<std::uint32_t> flags(set.size());
    for (std::uint32_t k = 0; k < kRealisations; ++k) {
      set.apply(realisation(layout, scene, expected, k), flux, flags);
      for (std::size_t i = 0; i < set.size(); ++i) {
        const EstimatorBudget& budget = estimators[i].budget;
        pulls[i].add((flux[i] - budget.target - budget.contaminants) / std::sqrt(budget.variance()));
      }
    }
    // 2500 realisations: a width is known to 1.41 %, a mean to 0.02; four sigma of twelve numbers of each method.
    for (std::size_t i = 0; i < set.size(); ++i) {
      std::cout << "star " << i << " pull " << pulls[i].mean() << " ± " << pulls[i].width() << '\n';
      EXPECT_NEAR(pulls[i].width(), 1.0, 4.0 / std::sqrt(2.0 * kRealisations)) << i;
      EXPECT_NEAR(pulls[i].mean(), 0.0, 4.0 / std::sqrt(kRealisations)) << i;
    }
  }
}

TEST(ImagePhotometry, StatesHonestErrors) {
  // Isolated stars, bright to lost in the noise; nothing is known of the image but gain, readout noise and the PSF.
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.9);
  scene.gain = Gain(4.0);
  scene.bias = Adu(300.0);
  scene.noise = {250.0, 12.0, 4.0 / std::sqrt(12.0)};
  const double fluxes[] = {2e5, 3e4, 5e3, 1.5e3};
  int n = 0;
  for (const PixelPosition p : {PixelPosition{15.2, 16.1}, {47.6, 15.3}, {16.4, 47.5}, {48.0, 48.9}})
    scene.add_target(p, fluxes[n++]);
  const auto layout = test::full_frame(kSide, kSide);
  const std::vector<double> expected = test::expected_electrons(*layout, scene);
  std::vector<SourceRequest> requests;
  for (const FieldStar& star : scene.stars) requests.push_back({star.id, star.position, std::nullopt});

  for (const PhotometryMethod method : {PhotometryMethod::kAperture, PhotometryMethod::kMask}) {
    ImagePhotometrySettings settings;
    settings.method = method;
    settings.psf = scene.psf;
    settings.annulus_inner = Pixels(6.0);
    settings.annulus_outer = Pixels(12.0);
    std::vector<Pull> pulls(requests.size());
    Pull all;
    double chi2 = 0.0;
    for (std::uint32_t k = 0; k < kRealisations; ++k) {
      const auto measured = measure_image(realisation(layout, scene, expected, k), nullptr, requests, settings);
      for (std::size_t i = 0; i < measured.size(); ++i) {
        pulls[i].add((measured[i].flux - scene.stars[i].electrons) / measured[i].flux_err);
        all.add((measured[i].flux - scene.stars[i].electrons) / measured[i].flux_err);
        chi2 += measured[i].chi2 / static_cast<double>(measured.size() * kRealisations);
      }
    }
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      std::cout << "star " << i << " pull " << pulls[i].mean() << " ± " << pulls[i].width() << '\n';
      EXPECT_NEAR(pulls[i].width(), 1.0, 0.03 + 3.0 / std::sqrt(2.0 * kRealisations)) << i;
    }
    std::cout << "all stars " << all.mean() << " ± " << all.width() << ", chi2 " << chi2 << '\n';
    EXPECT_NEAR(all.width(), 1.0, 0.03);
    EXPECT_NEAR(chi2, 1.0, 0.05);
  }
}

}  // namespace
}  // namespace astroid
