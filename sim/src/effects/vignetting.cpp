#include "effects/vignetting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "astroid/core/plane_kernels.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/sim/scene.hpp"

namespace astroid {

namespace {

constexpr int kStep = 16;  // px between exact values
constexpr std::size_t kTaps = 4;

/// Weights of the nodes -1 … 2 around a place between nodes 0 and 1.
std::array<double, kTaps> lagrange(double t) {
  constexpr double kSixth = 1.0 / 6.0;
  return {-kSixth * t * (t - 1.0) * (t - 2.0), 0.5 * (t + 1.0) * (t - 1.0) * (t - 2.0),
          -0.5 * (t + 1.0) * t * (t - 2.0), kSixth * (t + 1.0) * t * (t - 1.0)};
}

int node_below(int pixel) {
  return pixel >= 0 ? pixel / kStep : -((-pixel + kStep - 1) / kStep);
}

/// Vignetting at the nodes of a lattice, computed where it is asked for.
class Lattice {
 public:
  explicit Lattice(const Scene& scene) : scene_(scene) {}

  double node(int i, int j) {
    const auto [at, is_new] = values_.try_emplace({i, j});
    if (is_new)
      at->second = vignetting_at(scene_.mission().telescope.vignetting, *scene_.projection(),
                                 {static_cast<double>(i * kStep), static_cast<double>(j * kStep)});
    return at->second;
  }

  /// A row of pixels from (x0, y) on.
  void fill(int x0, int y, std::span<float> values) {
    const int j = node_below(y);
    const auto weights_y = lagrange(static_cast<double>(y - j * kStep) / kStep);
    const auto column = [&](int i) {
      double sum = 0.0;
      for (std::size_t b = 0; b < kTaps; ++b) sum += weights_y[b] * node(i, j - 1 + static_cast<int>(b));
      return sum;
    };
    int first = node_below(x0);
    std::array<double, kTaps> columns = {column(first - 1), column(first), column(first + 1), column(first + 2)};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const int x = x0 + static_cast<int>(k);
      if (x - first * kStep == kStep) {
        ++first;
        columns = {columns[1], columns[2], columns[3], column(first + 2)};
      }
      const auto weights_x = lagrange(static_cast<double>(x - first * kStep) / kStep);
      double sum = 0.0;
      for (std::size_t a = 0; a < kTaps; ++a) sum += weights_x[a] * columns[a];
      values[k] = static_cast<float>(std::clamp(sum, 0.0, 1.0));
    }
  }

 private:
  const Scene& scene_;
  std::map<std::pair<int, int>, double> values_;
};

}  // namespace

EffectNeed Vignetting::is_needed(const SceneSummary& scene) const {
  const double loss = 1.0 - scene.least_vignetting;
  if (!(loss > 0.0)) return {false, "no light is lost towards the edge of the field", 0.0, 0.0};
  const double flux = scene.brightest_target_electrons;
  const double bias = loss * (flux + scene.background * scene.aperture_pixels);
  // Losing light changes a flux's variance by no more than its share.
  return {bias > scene.flux_tolerance(flux) || loss > kVarianceTolerance,
          fmt::format("up to {:.3g} % of the light is lost towards the corners of the detector", 100.0 * loss), bias,
          loss};
}

void Vignetting::prepare(CameraState& camera, const PrepareContext& context) const {
  camera.vignetting = Plane<float, unit::Relative>(camera.layout);
  Lattice lattice(context.scene);
  for (std::size_t r = 0; r < camera.layout->exposed_regions().size(); ++r) {
    const auto view = camera.vignetting.view(r);
    for (int y = view.area().y0; y < view.area().y1(); ++y) lattice.fill(view.area().x0, y, view.row(y));
  }
}

void Vignetting::apply(ExposureState& state, const EffectContext& context, const Strip& strip) const {
  multiply_values(state.expected.pixels(strip), context.camera.vignetting.pixels().subspan(strip.begin, strip.size()));
}

}  // namespace astroid
