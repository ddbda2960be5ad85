// Two hundred random scenes, every renderer, one oracle: adaptive quadrature of the PSF over the pixels.
//
// A target with neighbours down to a hundredth of its flux and up to ten times as bright, at random positions, in
// squares of 1 to 5 pixels around it. The error is that of the light in the square, neighbours included, and has to
// stay below the accuracy asked for, relative to that light: 1 ppm, and 0.01 ppm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/core/sub_pixel.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/quadrature.hpp"

namespace astroid {
namespace {

constexpr int kScenes = 200;
constexpr Rectangle kFrame{0, 0, 32, 32};

/// Uniforms of one scene.
class Dice {
 public:
  explicit Dice(std::uint32_t scene) : scene_(scene) {}
  double operator()(double from, double to) {
    const RandomStream stream = make_stream(20270101, StreamId{0}, 0, 0);
    return from + (to - from) * uniform_at_step(stream, {.step = step_++, .axis = scene_});
  }

 private:
  std::uint32_t scene_;
  std::uint64_t step_ = 0;
};

/// A PSF with every renderer that can make it.
struct Optics {
  std::string name;
  test::SurfaceBrightness brightness;
  std::shared_ptr<const PixelPsf> stamps;  // analytic or prf
  std::shared_ptr<const PsfSpectrum> spectrum;
  double reach;              // px, beyond which is nothing that counts
  std::vector<int> squares;  // px, in which light is compared
};

/// Two Gaussians, one of them off centre: no symmetry. The light ends before the table does.
PsfTable made_up_table(double sigma, double samples_per_pixel) {
  const int n = 2 * static_cast<int>(std::ceil(6.0 * samples_per_pixel)) + 1;
  PsfTable table;
  table.samples = Image<double, unit::Relative>(n, n - 2);
  table.samples_per_pixel = samples_per_pixel;
  table.centre_x = 0.5 * (n - 1) + 0.3;
  table.centre_y = 0.5 * (n - 3) - 0.2;
  for (int y = 0; y < n - 2; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = (x - table.centre_x) / samples_per_pixel;
      const double v = (y - table.centre_y) / samples_per_pixel;
      const double core = std::exp(-0.5 * (u * u + 1.3 * v * v + 0.4 * u * v) / (sigma * sigma));
      const double side = 0.1 * std::exp(-0.5 * ((u - 0.7) * (u - 0.7) + v * v) / (1.2 * sigma * sigma));
      table.samples.at(x, y) = core + side;
    }
  return table;
}

Optics gaussian(double sigma) {
  return {"Gaussian",
          test::smooth_brightness(test::gaussian_density(sigma)),
          make_gaussian_psf(sigma),
          make_gaussian_spectrum(sigma),
          9.0 * sigma,
          {1, 3, 5}};
}

Optics tabulated(const PsfTable& table, double accuracy) {
  const auto brightness = test::table_brightness(table);
  const double reach = static_cast<double>(std::max({-brightness.x_breaks.front(), brightness.x_breaks.back(),
                                                     -brightness.y_breaks.front(), brightness.y_breaks.back()}));
  return {"table", brightness, make_prf_psf(table, accuracy), make_table_spectrum(table), reach, {}};
}

std::vector<StarLight> stars_of(Dice& dice) {
  std::vector<StarLight> stars = {{.centre = {dice(14.5, 16.5), dice(14.5, 16.5)}, .electrons = 1e5}};
  const int neighbours = static_cast<int>(dice(0.0, 13.0));
  for (int i = 0; i < neighbours; ++i) {
    const double flux = std::pow(10.0, dice(3.0, 6.0));
    stars.push_back({.centre = {dice(6.0, 25.0), dice(6.0, 25.0)}, .electrons = flux});
  }
  return stars;
}

/// Largest error relative to the light in squares around the target.
struct Errors {
  double stamps = 0.0;
  double sub_pixel = 0.0;
};

double light_in(std::span<const double> image, int x0, int y0, int n) {
  double sum = 0.0;
  for (int y = y0; y < y0 + n; ++y)
    for (int x = x0; x < x0 + n; ++x) sum += image[static_cast<std::size_t>(y * kFrame.nx + x)];
  return sum;
}

Errors errors_of(const Optics& optics, const SubPixelRenderer& renderer, const std::vector<StarLight>& stars) {
  std::vector<double> convolved(kFrame.size());
  SubPixelRenderer::Workspace workspace;
  for (const Rectangle& tile : renderer.tiles()) {
    std::vector<double> light(tile.size());
    renderer.render(tile, stars, workspace, light);
    for (int y = tile.y0; y < tile.y1(); ++y)
      for (int x = tile.x0; x < tile.x1(); ++x)
        convolved[static_cast<std::size_t>(y * kFrame.nx + x)] =
            light[static_cast<std::size_t>((y - tile.y0) * tile.nx + x - tile.x0)];
  }
  Image<double, unit::ExpectedElectrons> stamped(kFrame);
  std::vector<double> scratch;
  for (StarLight star : stars) {
    star.half_width = optics.reach;
    optics.stamps->add_star(star, stamped.view(), scratch);
  }
  Errors errors;
  for (const int n : optics.squares) {
    const int x0 = static_cast<int>(std::lround(stars[0].centre.x)) - n / 2;
    const int y0 = static_cast<int>(std::lround(stars[0].centre.y)) - n / 2;
    test::Integral exact;
    for (const StarLight& star : stars) {
      test::Integral one = test::integrate_area(optics.brightness, star.centre, test::area_of({x0, y0, n, n}), 1e-13L);
      one.value *= static_cast<long double>(star.electrons);
      one.error *= static_cast<long double>(star.electrons);
      exact += one;
    }
    EXPECT_LT(static_cast<double>(exact.error / exact.value), 1e-10);
    const auto truth = static_cast<double>(exact.value);
    errors.stamps = std::max(errors.stamps, std::abs(light_in(stamped.pixels(), x0, y0, n) / truth - 1.0));
    errors.sub_pixel = std::max(errors.sub_pixel, std::abs(light_in(convolved, x0, y0, n) / truth - 1.0));
  }
  return errors;
}

class TwoHundredScenes : public testing::TestWithParam<double> {};

TEST_P(TwoHundredScenes, AgreeWithTheOracleInEveryRenderer) {
  const double accuracy = GetParam();
  constexpr int kTables = 3;
  // A tabulated PSF is asked for more than a star alone needs: light of brighter neighbours is in the squares.
  constexpr double kPrfShare = 0.1;
  constexpr double kMapShare = 0.3;
  // What a table means is known to 10 ppb only where it is fine: coarse ones have spectra without end.
  const bool tight = accuracy < 1e-7;
  // Tables are dear to prepare, so scenes share some.
  std::vector<Optics> tables;
  std::vector<std::unique_ptr<SubPixelRenderer>> table_renderers;
  for (int i = 0; i < kTables; ++i) {
    tables.push_back(tabulated(made_up_table(0.6 + 0.1 * i, tight ? 48.0 : 16.0 + i), kPrfShare * accuracy));
    tables.back().squares = tight ? std::vector{1, 2} : std::vector{1, 3};
    table_renderers.push_back(std::make_unique<SubPixelRenderer>(tables.back().spectrum, kFrame,
                                                                 SubPixelSettings{.accuracy = kMapShare * accuracy}));
  }
  std::map<std::string, Errors> worst;
  for (int scene = 0; scene < kScenes; ++scene) {
    Dice dice(static_cast<std::uint32_t>(scene));
    const bool is_table = scene % 3 == 2;
    const double sigma = dice(0.3, 3.0);
    const auto stars = stars_of(dice);
    Errors errors;
    if (is_table) {
      const auto which = static_cast<std::size_t>(scene / 3 % kTables);
      errors = errors_of(tables[which], *table_renderers[which], stars);
    } else {
      // Bright neighbours count: the light of the target in a pixel may be a thousandth of all.
      constexpr double kShare = 1e-3;
      const SubPixelRenderer renderer(make_gaussian_spectrum(sigma), kFrame, {.accuracy = kShare * accuracy});
      errors = errors_of(gaussian(sigma), renderer, stars);
    }
    const std::string kind = is_table ? "table" : "Gaussian";
    EXPECT_LT(errors.stamps, accuracy) << "scene " << scene << " " << kind << ", " << stars.size() << " stars";
    EXPECT_LT(errors.sub_pixel, accuracy) << "scene " << scene << " " << kind << ", " << stars.size() << " stars";
    worst[kind].stamps = std::max(worst[kind].stamps, errors.stamps);
    worst[kind].sub_pixel = std::max(worst[kind].sub_pixel, errors.sub_pixel);
  }
  std::printf("accuracy %g: analytic %.2g, subpixel of Gaussians %.2g, prf %.2g, subpixel of tables %.2g\n", accuracy,
              worst["Gaussian"].stamps, worst["Gaussian"].sub_pixel, worst["table"].stamps, worst["table"].sub_pixel);
}

INSTANTIATE_TEST_SUITE_P(Renderers, TwoHundredScenes, testing::Values(1e-6, 1e-8),
                         [](const auto& accuracy) { return accuracy.param < 1e-7 ? "Within10ppb" : "Within1ppm"; });

}  // namespace
}  // namespace astroid
