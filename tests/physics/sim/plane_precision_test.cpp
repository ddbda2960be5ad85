// What single precision costs where, in ppm of a star's flux: why expected electrons accumulate in double and why maps
// of small motions and normals need not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kSide = 96;

/// A crowd of faint stars with a few very bright ones.
std::vector<test::LabStar> crowd() {
  const RandomStream stream = make_stream(6, StreamId{77}, 0, 0);
  std::vector<test::LabStar> stars;
  for (std::size_t i = 0; i < 1300; ++i) {
    const auto u = [&](std::uint32_t axis) { return uniform_at_step(stream, {.step = i, .axis = axis}); };
    stars.push_back({kSide * u(0) - 0.5, kSide * u(1) - 0.5, std::min(3e7, 4000.0 * std::pow(u(2), -1.3))});
  }
  return stars;
}

template <class Number>
std::vector<double> aperture_fluxes(const std::vector<Number>& image, const std::vector<test::LabStar>& stars) {
  std::vector<double> fluxes;
  for (const test::LabStar& star : stars) {
    double sum = 0.0;
    for (int y = static_cast<int>(std::floor(star.y + 0.5)) - 1, j = 0; j < 3; ++j, ++y)
      for (int x = static_cast<int>(std::floor(star.x + 0.5)) - 1, i = 0; i < 3; ++i, ++x)
        if (x >= 0 && y >= 0 && x < kSide && y < kSide)
          sum += static_cast<double>(image[static_cast<std::size_t>(y * kSide + x)]);
    fluxes.push_back(sum);
  }
  return fluxes;
}

/// The image in numbers of one kind, by plain addition.
template <class Number>
std::vector<Number> render(const std::vector<test::LabStar>& stars, const PixelPsf& psf) {
  std::vector<Number> image(static_cast<std::size_t>(kSide * kSide), Number{945});
  std::vector<double> fractions;
  for (const test::LabStar& star : stars) {
    const Rectangle box = intersect(stamp_box({star.x, star.y}, 4.5), {0, 0, kSide, kSide});
    fractions.resize(box.size());
    psf.integrate({star.x, star.y}, box, fractions);
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x) {
        Number& pixel = image[static_cast<std::size_t>(y * kSide + x)];
        pixel = pixel + static_cast<Number>(star.electrons * fractions[k++]);
      }
  }
  return image;
}

double worst_ppm(const std::vector<double>& measured, const std::vector<double>& exact,
                 const std::vector<test::LabStar>& stars) {
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    worst = std::max(worst, 1e6 * std::abs(measured[i] - exact[i]) / stars[i].electrons);
  return worst;
}

TEST(PlanePrecision, SinglePrecisionPlanesWouldBreakTheAccuracyAndDoubleOnesDoNot) {
  const std::vector<test::LabStar> stars = crowd();
  const auto psf = make_gaussian_psf(0.6);
  const std::vector<double> exact = aperture_fluxes(render<long double>(stars, *psf), stars);
  const double single = worst_ppm(aperture_fluxes(render<float>(stars, *psf), stars), exact, stars);
  const double twice = worst_ppm(aperture_fluxes(render<double>(stars, *psf), stars), exact, stars);
  std::printf("largest error of a star's flux: float planes %.3g ppm, double planes %.3g ppm\n", single, twice);
  EXPECT_GT(single, 10.0);  // of the faintest stars beside the brightest
  EXPECT_LT(twice, 1e-6);
}

TEST(PlanePrecision, SinglePrecisionMapsOfSmallMotionsKeepTheAccuracy) {
  // Maps are multiplied by motions of a hundredth of a pixel: what they round is a hundredth of the light or less.
  Mission mission = test::plato_mission(kSide, kSide);
  mission.simulation.exposures = 50;
  const std::vector<test::LabStar> stars = crowd();
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  auto plan = std::make_shared<Plan>(make_plan(*scene));
  ASSERT_EQ(plan->knobs.jitter, JitterTreatment::kPolynomial);
  auto stepwise = std::make_shared<Plan>(*plan);
  stepwise->knobs.jitter = JitterTreatment::kSubSteps;
  const Simulator recalled(scene, plan, 0);
  const Simulator rendered(scene, stepwise, 0);
  ExposureState a = recalled.make_state();
  ExposureState b = rendered.make_state();
  double worst = 0.0;
  for (const std::int64_t exposure : {3, 20, 49}) {
    recalled.expect(exposure, a);
    rendered.expect(exposure, b);
    const auto pixels = [](ExposureState& s) {
      return std::vector<double>(s.expected.whole().pixels().begin(), s.expected.whole().pixels().end());
    };
    worst = std::max(worst, worst_ppm(aperture_fluxes(pixels(a), stars), aperture_fluxes(pixels(b), stars), stars));
  }
  std::printf("largest error of a star's own flux by maps: %.3g ppm\n", worst);
  EXPECT_LT(worst, 10.0);  // of the faintest star, under the wing of one 7500 times brighter
}

TEST(PlanePrecision, SinglePrecisionNormalsMoveNoCount) {
  // Readout noise of 50 e- from single instead of double normals: less than 1e-4 e- in any pixel, against 25 e- a
  // count.
  const RandomStream stream = make_stream(1, StreamId{9}, 0, 0);
  std::vector<double> single(20000, 0.0);
  std::vector<double> exact(single.size());
  const Rectangle row{0, 0, static_cast<int>(single.size()), 1};
  add_pixel_normals(stream, {.areas = {&row, 1}}, 50.2, single);
  normal_row(stream, {}, exact);
  double worst = 0.0;
  for (std::size_t i = 0; i < single.size(); ++i) worst = std::max(worst, std::abs(single[i] - 50.2 * exact[i]));
  std::printf("largest difference: %.2g e-\n", worst);
  EXPECT_LT(worst, 1e-4);
}

}  // namespace
}  // namespace astroid
