// Small scenes for tests of photometry: what the ground believes, and frames drawn from exactly that belief.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "astroid/core/frame.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/random.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/estimator.hpp"

namespace astroid::test {

/// Stars, PSF and noise of a scene; owns what a GroundModel points at.
struct GroundScene {
  std::vector<FieldStar> stars;
  std::vector<std::size_t> targets;
  std::shared_ptr<const PixelPsf> psf;
  PixelNoise noise;
  Gain gain{1.0};
  Adu bias;

  void add_target(PixelPosition position, double electrons) {
    targets.push_back(stars.size());
    add_star(position, electrons);
  }
  void add_star(PixelPosition position, double electrons) {
    stars.push_back({"star-" + std::to_string(stars.size()), position, electrons});
  }
  [[nodiscard]] GroundModel model() const {
    GroundModel model;
    model.stars = stars;
    model.targets = targets;
    model.psf = psf.get();
    model.noise = noise;
    model.gain = gain;
    model.bias = bias;
    return model;
  }
};

/// A frame of zeros over a layout.
inline Frame empty_frame(const std::shared_ptr<const PixelLayout>& layout, Gain gain = Gain(1.0), Adu bias = Adu(0.0)) {
  Frame frame;
  frame.pixels = Plane<float, unit::Adu>(layout);
  frame.flags = Plane<std::uint8_t, unit::Flags>(layout);
  frame.header.gain = gain;
  frame.header.bias = bias;
  return frame;
}

inline std::shared_ptr<const PixelLayout> full_frame(int nx, int ny) {
  return std::make_shared<const PixelLayout>(std::vector<Rectangle>{{0, 0, nx, ny}});
}

/// Mean electrons of every pixel: background and all stars, each star over the whole layout.
inline std::vector<double> expected_electrons(const PixelLayout& layout, const GroundScene& scene) {
  std::vector<double> light(layout.size(), scene.noise.background);
  std::vector<double> fractions;
  for (const FieldStar& star : scene.stars) {
    for (std::size_t r = 0; r < layout.regions().size(); ++r) {
      const Rectangle& box = layout.regions()[r];
      fractions.resize(box.size());
      scene.psf->integrate(star.position, box, fractions);
      for (std::size_t i = 0; i < fractions.size(); ++i) light[layout.offset(r) + i] += star.electrons * fractions[i];
    }
  }
  return light;
}

/// Turns electrons into counts without rounding.
inline Frame frame_of(const std::shared_ptr<const PixelLayout>& layout, const GroundScene& scene,
                      std::span<const double> electrons) {
  Frame frame = empty_frame(layout, scene.gain, scene.bias);
  for (std::size_t i = 0; i < electrons.size(); ++i)
    frame.pixels.pixels()[i] = static_cast<float>(electrons[i] / scene.gain.value() + scene.bias.value());
  return frame;
}

/// Numbers for tests, each addressed by (realisation, index).
class TestNoise {
 public:
  explicit TestNoise(std::uint64_t seed) : stream_(make_stream(seed, StreamId{0x7e57U}, 0, 0)) {}

  /// Standard normal deviate (Box-Muller).
  [[nodiscard]] double normal(std::uint32_t realisation, std::uint32_t index) const {
    const RandomWords words = philox4x32(stream_, {index, realisation, 0, 0});
    return std::sqrt(-2.0 * det::log(open_unit(words[0]))) * det::cos(2.0 * kPi * open_unit(words[1]));
  }
  /// A uniform in (0, 1).
  [[nodiscard]] double uniform(std::uint32_t realisation, std::uint32_t index) const {
    return open_unit(philox4x32(stream_, {index, realisation, 1, 0})[0]);
  }
  /// Photon noise with the right mean and variance: a rounded normal deviate, so for means above about 20 only.
  [[nodiscard]] double photons(double mean, std::uint32_t realisation, std::uint32_t index) const {
    return std::floor(mean + std::sqrt(mean) * normal(realisation, index) + 0.5);
  }

 private:
  static double open_unit(std::uint32_t word) { return (static_cast<double>(word) + 0.5) * 0x1p-32; }
  RandomStream stream_;
};

/// One noisy exposure: photon noise and readout noise about `expected`.
inline Frame noisy_frame(const std::shared_ptr<const PixelLayout>& layout, const GroundScene& scene,
                         std::span<const double> expected, const TestNoise& noise, std::uint32_t realisation) {
  std::vector<double> electrons(expected.size());
  const auto count = static_cast<std::uint32_t>(expected.size());
  for (std::uint32_t i = 0; i < count; ++i)
    electrons[i] =
        noise.photons(expected[i], realisation, i) + scene.noise.readout * noise.normal(realisation, count + i);
  return frame_of(layout, scene, electrons);
}

}  // namespace astroid::test
