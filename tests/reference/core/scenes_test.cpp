// Two hundred random scenes, every renderer, one oracle: adaptive quadrature of the PSF over the pixels.
//
// A target with neighbours down to a hundredth of its flux and up to ten times as bright, at random positions, in
// squares of 1 to 5 pixels around it. The error is that of the light in the square, neighbours included, and has to
// stay below the accuracy asked for, relative to that light: 1 ppm, and 0.01 ppm, which of an Airy pattern the
// sub-pixel renderer alone is asked for: its wings have more rings than a library has phases.
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
  // What there is at any place: parts of the light, each with a brightness of its own.
  std::vector<test::SurfaceBrightness> brightness;
  std::shared_ptr<const PixelPsf> stamps;  // analytic or prf
  FieldSpectrum spectrum;
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
          {test::smooth_brightness(test::gaussian_density(sigma))},
          make_gaussian_psf(sigma),
          {.members = {make_gaussian_spectrum(sigma)}, .weights = {}},
          9.0 * sigma,
          {1, 3, 5}};
}

double reach_of(const test::SurfaceBrightness& brightness) {
  return static_cast<double>(std::max({-brightness.x_breaks.front(), brightness.x_breaks.back(),
                                       -brightness.y_breaks.front(), brightness.y_breaks.back()}));
}

Optics tabulated(const PsfTable& table, double accuracy) {
  const auto brightness = test::table_brightness(table);
  return {"table",
          {brightness},
          make_prf_psf(table, accuracy),
          {.members = {make_table_spectrum(table)}, .weights = {}},
          reach_of(brightness),
          {}};
}

constexpr PsfWings kWings{.reach = 20};

Optics moffat(double fwhm, double beta, double accuracy) {
  const auto density = test::moffat_density(static_cast<long double>(fwhm), static_cast<long double>(beta));
  return {"Moffat",
          {test::faded_brightness(density, kWings.reach)},
          make_moffat_psf(fwhm, beta, kWings, accuracy),
          {.members = {make_moffat_spectrum(fwhm, beta, kWings)}, .weights = {}},
          kWings.reach,
          {1, 3}};
}

Optics airy(double lambda_over_d, double obscuration, double accuracy) {
  const auto density =
      test::airy_density(static_cast<long double>(lambda_over_d), static_cast<long double>(obscuration));
  return {"Airy",
          {test::faded_brightness(density, kWings.reach)},
          make_airy_psf(lambda_over_d, obscuration, kWings, accuracy),
          {.members = {make_airy_spectrum(lambda_over_d, obscuration, kWings)}, .weights = {}},
          kWings.reach,
          {1, 3}};
}

/// Three tables at places between which every star has a blend that is linear in its place.
Optics field(double samples_per_pixel, double accuracy) {
  std::vector<FieldPsfTable> tables;
  tables.push_back({{0.0, 0.0}, made_up_table(0.6, samples_per_pixel)});
  tables.push_back({{32.0, 0.0}, made_up_table(0.7, samples_per_pixel)});
  tables.push_back({{0.0, 32.0}, made_up_table(0.8, samples_per_pixel)});
  Optics optics{"field", {},    make_field_psf(tables, Pixels(0.0), accuracy), make_field_spectrum(tables, Pixels(0.0)),
                0.0,     {1, 3}};
  for (const FieldPsfTable& table : tables) {
    optics.brightness.push_back(test::table_brightness(table.table));
    optics.reach = std::max(optics.reach, reach_of(optics.brightness.back()));
  }
  return optics;
}

/// Parts of a star's light: those of field(), by their own formula.
std::vector<double> parts_at(const Optics& optics, PixelPosition place) {
  if (optics.brightness.size() == 1) return {1.0};
  return {1.0 - (place.x + place.y) / 32.0, place.x / 32.0, place.y / 32.0};
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
      const std::vector<double> parts = parts_at(optics, star.centre);
      for (std::size_t k = 0; k < parts.size(); ++k) {
        test::Integral one =
            test::integrate_area(optics.brightness[k], star.centre, test::area_of({x0, y0, n, n}), 1e-13L);
        one.value *= static_cast<long double>(star.electrons * parts[k]);
        one.error *= static_cast<long double>(star.electrons * std::abs(parts[k]));
        exact += one;
      }
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
  // Single pixels are compared too, which err more than the small apertures that accuracy is judged by.
  constexpr double kPrfShare = 0.3;
  constexpr double kMapShare = 0.3;
  // What a table means is known to 10 ppb only where it is fine: coarse ones have spectra without end.
  const bool tight = accuracy < 1e-7;
  struct Prepared {
    Optics optics;
    std::unique_ptr<SubPixelRenderer> renderer;
    bool library;  // whether stamps are as good as the accuracy
  };
  // These are dear to prepare, so scenes share some.
  std::vector<Prepared> prepared;
  const auto prepare = [&](Optics optics, const SubPixelSettings& settings, bool library) {
    auto renderer = std::make_unique<SubPixelRenderer>(optics.spectrum, kFrame, settings);
    prepared.push_back({std::move(optics), std::move(renderer), library});
  };
  const SubPixelSettings by_accuracy{.accuracy = kMapShare * accuracy};
  for (int i = 0; i < kTables; ++i) {
    Optics table = tabulated(made_up_table(0.6 + 0.1 * i, tight ? 48.0 : 16.0 + i), kPrfShare * accuracy);
    table.squares = tight ? std::vector{1, 2} : std::vector{1, 3};
    prepare(std::move(table), by_accuracy, true);
  }
  // Blends may have three times the error of a table, which is more than 10 ppb leave.
  prepare(field(tight ? 48.0 : 16.0, kPrfShare * accuracy), {.accuracy = (tight ? 3.0 : 1.0) * by_accuracy.accuracy},
          true);
  prepare(moffat(1.4, 2.5, kPrfShare * accuracy), by_accuracy, true);
  prepare(moffat(2.1, 4.0, kPrfShare * accuracy), by_accuracy, true);
  // A library of rings that fits into the memory is as good as 1 ppm, but no better.
  prepare(airy(1.5, 0.3, tight ? 1e-6 : kPrfShare * accuracy), by_accuracy, !tight);
  // Every third scene is one of the tables and every third another of these; oracles of rings take long.
  const auto choose = [&](int scene) -> Prepared* {
    constexpr int kOfOthers = 10;
    const auto table = static_cast<std::size_t>(scene / 3 % kTables);
    if (scene % 3 == 2) return &prepared[table];
    if (scene % 3 == 0) return nullptr;
    const int other = scene / 3 % kOfOthers;
    if (other == 0) return &prepared.back();
    return &prepared[static_cast<std::size_t>(kTables + other % 3)];
  };
  std::map<std::string, Errors> worst;
  for (int scene = 0; scene < kScenes; ++scene) {
    Dice dice(static_cast<std::uint32_t>(scene));
    const double sigma = dice(0.3, 3.0);
    const auto stars = stars_of(dice);
    Errors errors;
    std::string kind = "Gaussian";
    bool library = true;
    if (const Prepared* shared = choose(scene); shared != nullptr) {
      errors = errors_of(shared->optics, *shared->renderer, stars);
      kind = shared->optics.name;
      library = shared->library;
    } else {
      // Bright neighbours count: the light of the target in a pixel may be a thousandth of all.
      constexpr double kShare = 1e-3;
      const SubPixelRenderer renderer(make_gaussian_spectrum(sigma), kFrame, {.accuracy = kShare * accuracy});
      errors = errors_of(gaussian(sigma), renderer, stars);
    }
    if (library) {
      EXPECT_LT(errors.stamps, accuracy) << "scene " << scene << " " << kind << ", " << stars.size() << " stars";
    }
    EXPECT_LT(errors.sub_pixel, accuracy) << "scene " << scene << " " << kind << ", " << stars.size() << " stars";
    worst[kind].stamps = std::max(worst[kind].stamps, errors.stamps);
    worst[kind].sub_pixel = std::max(worst[kind].sub_pixel, errors.sub_pixel);
  }
  for (const auto& [kind, errors] : worst)
    std::printf("accuracy %g, %s: stamps %.2g, subpixel %.2g\n", accuracy, kind.c_str(), errors.stamps,
                errors.sub_pixel);
}

INSTANTIATE_TEST_SUITE_P(Renderers, TwoHundredScenes, testing::Values(1e-6, 1e-8),
                         [](const auto& accuracy) { return accuracy.param < 1e-7 ? "Within10ppb" : "Within1ppm"; });

}  // namespace
}  // namespace astroid
