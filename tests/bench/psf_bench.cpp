// Time per star of the PSF renderers and of choosing a mask.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "astroid/core/distortion.hpp"
#include "astroid/core/noise.hpp"
#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

constexpr double kSigma = 0.6;   // px
constexpr int kImageSide = 200;  // px

// Stars that meet every sub-pixel phase.
PixelPosition star(int k) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kPlastic = 0.7548776662466927;
  return {100.0 + std::fmod(k * kGolden, 1.0), 100.0 + std::fmod(k * kPlastic, 1.0)};
}

Rectangle box_of(int side) {
  return {100 - side / 2, 100 - side / 2, side, side};
}

template <class Render>
void each_star(benchmark::State& state, Render&& render) {
  const Rectangle box = box_of(static_cast<int>(state.range(0)));
  int k = 0;
  while (state.KeepRunning()) {
    render(star(k), box);
    k = (k + 1) % 1000;
  }
  state.SetItemsProcessed(state.iterations());
}

void BM_GaussianStamp(benchmark::State& state) {
  const auto psf = make_gaussian_psf(kSigma);
  std::vector<double> p(box_of(static_cast<int>(state.range(0))).size());
  each_star(state, [&](PixelPosition at, Rectangle box) {
    psf->integrate(at, box, p);
    benchmark::DoNotOptimize(p.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(BM_GaussianStamp)->Arg(6)->Arg(11)->Arg(21);

void BM_GaussianGradient(benchmark::State& state) {
  const auto psf = make_gaussian_psf(kSigma);
  std::vector<double> x(box_of(static_cast<int>(state.range(0))).size());
  std::vector<double> y(x.size());
  each_star(state, [&](PixelPosition at, Rectangle box) {
    psf->integrate_gradient(at, box, x, y);
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(BM_GaussianGradient)->Arg(6)->Arg(11);

// A Moffat profile: not separable, with wings.
PsfTable moffat_table() {
  constexpr int kSamplesPerPixel = 16;
  constexpr int kHalfWidth = 8;  // px
  const int n = 2 * kHalfWidth * kSamplesPerPixel;
  PsfTable table;
  table.samples = Image<double, unit::Relative>(n, n);
  table.samples_per_pixel = kSamplesPerPixel;
  table.centre_x = table.centre_y = 0.5 * (n - 1);
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double r = std::hypot(x - table.centre_x, y - table.centre_y) / kSamplesPerPixel;
      table.samples.at(x, y) = std::pow(1.0 + r * r, -2.5);
    }
  }
  return table;
}

void BM_TableStamp(benchmark::State& state) {
  const auto psf = make_prf_psf(moffat_table(), 1e-6);
  std::vector<double> p(box_of(static_cast<int>(state.range(0))).size());
  each_star(state, [&](PixelPosition at, Rectangle box) {
    psf->integrate(at, box, p);
    benchmark::DoNotOptimize(p.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(BM_TableStamp)->Arg(6)->Arg(11)->Arg(21);

void BM_TableLibrary(benchmark::State& state) {
  const PsfTable table = moffat_table();
  while (state.KeepRunning()) benchmark::DoNotOptimize(make_prf_psf(table, 1e-6));
}
BENCHMARK(BM_TableLibrary)->Unit(benchmark::kMillisecond);

// ---- The optics ----

std::shared_ptr<const PixelPsf> profile_psf(std::int64_t number) {
  constexpr double kAccuracy = 4e-7;
  if (number == 0) return make_moffat_psf(1.4, 2.5, {}, kAccuracy);
  if (number == 1) return make_airy_psf(1.5, 0.3, {}, kAccuracy);
  return make_airy_psf(1.5, 0.3, {.diffusion = 0.2}, kAccuracy);
}

/// Making the library: 0 Moffat, 1 Airy, 2 Airy with charge diffusion.
void BM_ProfileLibrary(benchmark::State& state) {
  while (state.KeepRunning()) benchmark::DoNotOptimize(profile_psf(state.range(0)));
}
BENCHMARK(BM_ProfileLibrary)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

/// A Moffat star in a stamp of 9 px, inside the core, and of 61 px.
void BM_AddProfileStar(benchmark::State& state) {
  const auto psf = profile_psf(0);
  Image<double, unit::ExpectedElectrons> image(kImageSide, kImageSide);
  std::vector<double> scratch;
  int k = 0;
  while (state.KeepRunning()) {
    psf->add_star({.centre = star(k), .electrons = 1e4, .half_width = 0.5 * static_cast<double>(state.range(0) - 1)},
                  image.view(), scratch);
    k = (k + 1) % 1000;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_AddProfileStar)->Arg(9)->Arg(61);

/// PLATO's distortion, all over its field: 0 forward, 1 inverse.
void BM_Distortion(benchmark::State& state) {
  constexpr double kFocalLength = 13750.987;  // px, of 15 arcsec/px
  const auto distortion =
      make_radial_distortion({.k1 = 0.32419, .k2 = 0.0232909, .k3 = 0.407979}, Pixels(kFocalLength));
  int k = 0;
  while (state.KeepRunning()) {
    const PixelShift p{3000.0 * std::fmod(k * 0.618, 1.0), 3000.0 * std::fmod(k * 0.755, 1.0)};
    benchmark::DoNotOptimize(state.range(0) == 0 ? distortion->distort(p) : distortion->undistort(p));
    k = (k + 1) % 1000;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Distortion)->Arg(0)->Arg(1);

// ---- A star on its way to an image ----

/// How a star is rendered.
struct Rendering {
  const char* name;
  bool table;
  bool broadened;
};
constexpr Rendering kRenderings[] = {{"Gaussian, still", false, false},
                                     {"Gaussian, broadened", false, true},
                                     {"PRF, still", true, false},
                                     {"PRF, broadened", true, true}};
constexpr MotionCovariance kMotion{.sxx = 4e-4, .sxy = 1e-4, .syy = 3e-4};  // px²

std::shared_ptr<const PixelPsf> psf_of(const Rendering& rendering) {
  return rendering.table ? make_prf_psf(moffat_table(), 1e-6) : make_gaussian_psf(kSigma);
}

/// The half-width whose stamps have `side` pixels an axis.
double half_width_of(std::int64_t side) {
  return 0.5 * static_cast<double>(side - 1);
}

StarLight light_of(int k, std::int64_t side, const Rendering& rendering) {
  return {.centre = star(k),
          .electrons = 1e4,
          .half_width = half_width_of(side),
          .motion = kMotion,
          .broadened = rendering.broadened};
}

void renderings_and_sides(benchmark::internal::Benchmark* b) {
  b->ArgNames({"rendering", "side"})->ArgsProduct({{0, 1, 2, 3}, {5, 7, 9, 11, 15}});
}

/// add_star(), which the simulation takes.
void BM_AddStar(benchmark::State& state) {
  const Rendering& rendering = kRenderings[state.range(0)];
  const auto psf = psf_of(rendering);
  Image<double, unit::ExpectedElectrons> image(kImageSide, kImageSide);
  std::vector<double> scratch;
  int k = 0;
  for (auto _ : state) {
    psf->add_star(light_of(k, state.range(1), rendering), image.view(), scratch);
    benchmark::ClobberMemory();
    k = (k + 1) % 1000;
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(rendering.name);
}
BENCHMARK(BM_AddStar)->Apply(renderings_and_sides);

/// The same from the fractions of every pixel, which photometry takes.
void BM_IntegrateAndAdd(benchmark::State& state) {
  const Rendering& rendering = kRenderings[state.range(0)];
  const auto psf = psf_of(rendering);
  Image<double, unit::ExpectedElectrons> image(kImageSide, kImageSide);
  std::vector<double> fractions;
  std::vector<double> scratch;
  int k = 0;
  for (auto _ : state) {
    const StarLight light = light_of(k, state.range(1), rendering);
    const Rectangle box = stamp_box(light.centre, light.half_width);
    fractions.resize(box.size());
    if (light.broadened)
      psf->integrate_broadened(light.centre, light.motion, box, fractions, scratch);
    else
      psf->integrate(light.centre, box, fractions);
    auto fraction = fractions.begin();
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x) image.at(x, y) += light.electrons * *fraction++;
    benchmark::ClobberMemory();
    k = (k + 1) % 1000;
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(rendering.name);
}
BENCHMARK(BM_IntegrateAndAdd)->Apply(renderings_and_sides);

void BM_OptimalMask(benchmark::State& state) {
  const Rectangle box = box_of(6);
  std::vector<double> target(box.size());
  make_gaussian_psf(kSigma)->integrate(star(7), box, target);
  for (double& e : target) e *= 1e5;
  const PixelNoise noise{.background = 945.0, .readout = 50.2, .quantisation = 7.2};
  while (state.KeepRunning()) benchmark::DoNotOptimize(optimal_binary_mask(target, target, noise));
}
BENCHMARK(BM_OptimalMask);

}  // namespace
}  // namespace astroid
