// Several frames measured at once against the same frames measured one by one: the same bits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "astroid/core/error.hpp"
#include "astroid/core/vector_target.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 37;  // so few that a batch is interleaved for masks, too
constexpr int kRows = 30;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A crowd, a star beyond the edge and one that is cut by it.
test::GroundScene crowded_scene() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.7);
  scene.noise = {945.0, 50.2, 7.2};
  scene.gain = Gain(25.0);
  scene.bias = Adu(1000.0);
  const test::TestNoise noise(3);
  for (std::uint32_t i = 0; i < 90; ++i)
    scene.add_target({kColumns * noise.uniform(0, i), kRows * noise.uniform(1, i)},
                     3000.0 * std::exp(5.0 * noise.uniform(2, i)));
  scene.add_target({-20.0, 5.0}, 1e5);
  scene.add_target({0.0, kRows - 1.0}, 1e5);
  return scene;
}

// Which pixels are saturated, defective or not finite.
enum class Spoilt { kNone, kTheSameInAllFrames, kInEveryOtherFrame };

std::vector<Frame> frames_of(const test::GroundScene& scene, const std::shared_ptr<const PixelLayout>& layout,
                             std::size_t count, Spoilt spoilt) {
  const std::vector<double> expected = test::expected_electrons(*layout, scene);
  const test::TestNoise noise(4);
  std::vector<Frame> frames;
  for (std::uint32_t f = 0; f < count; ++f) {
    frames.push_back(test::noisy_frame(layout, scene, expected, noise, f));
    const std::uint32_t pattern = spoilt == Spoilt::kInEveryOtherFrame ? 1000 + f : 1000;
    const auto any_pixel = [&](std::uint32_t i) {
      return static_cast<std::size_t>(static_cast<double>(layout->size()) * noise.uniform(pattern, i));
    };
    if (spoilt == Spoilt::kNone || (spoilt == Spoilt::kInEveryOtherFrame && f % 2 == 0)) continue;
    Frame& frame = frames.back();
    for (std::uint32_t i = 0; i < 4; ++i) {
      frame.flags.pixels()[any_pixel(6 * i)] = pixel_flag::kFullWell;
      frame.flags.pixels()[any_pixel(6 * i + 1)] = pixel_flag::kAdcSaturated;
      frame.flags.pixels()[any_pixel(6 * i + 2)] = pixel_flag::kBad;
      frame.pixels.pixels()[any_pixel(6 * i + 3)] = kNan;
      frame.pixels.pixels()[any_pixel(6 * i + 4)] = kInfinity;
      frame.pixels.pixels()[any_pixel(6 * i + 5)] = -kInfinity;
    }
    // A region without a good pixel: the known background stands in.
    for (std::size_t p = 0; p < layout->size() / 8; ++p) frame.flags.pixels()[p] |= pixel_flag::kBad;
  }
  return frames;
}

// Compares a batch with single frames, target by target.  Counts the fluxes that were compared and the flags seen.
struct Comparison {
  std::size_t fluxes = 0;
  std::uint32_t flags = 0;
};
Comparison compare(const EstimatorSet& set, std::span<const Frame> frames) {
  Comparison seen;
  std::vector<std::vector<double>> flux(frames.size(), std::vector<double>(set.size()));
  std::vector<std::vector<std::uint32_t>> flags(frames.size(), std::vector<std::uint32_t>(set.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) set.apply(frames[f], flux[f], flags[f]);
  EstimatorSet::BatchScratch scratch;
  std::vector<int> calls(set.size());
  set.apply_batch(
      frames, scratch,
      [&](std::size_t target, std::span<const double> of_batch, std::span<const std::uint32_t> batch_flags) {
        ++calls[target];
        ASSERT_EQ(of_batch.size(), frames.size());
        ASSERT_EQ(batch_flags.size(), frames.size());
        for (std::size_t f = 0; f < frames.size(); ++f) {
          EXPECT_EQ(std::bit_cast<std::uint64_t>(of_batch[f]), std::bit_cast<std::uint64_t>(flux[f][target]))
              << "target " << target << " in frame " << f << " of " << frames.size() << ": " << of_batch[f]
              << " is not " << flux[f][target];
          EXPECT_EQ(batch_flags[f], flags[f][target]) << "target " << target << " in frame " << f;
          seen.flags |= batch_flags[f];
          ++seen.fluxes;
        }
      });
  EXPECT_THAT(calls, testing::Each(1));
  return seen;
}

using Case = std::tuple<PhotometryMethod, BackgroundMethod, Spoilt>;

class EstimatorBatch : public testing::TestWithParam<Case> {};

TEST_P(EstimatorBatch, HasTheBitsOfSingleFrames) {
  const auto [method, background, spoilt] = GetParam();
  PhotometrySettings settings;
  settings.method = method;
  settings.background = background;
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(kColumns, kRows);
  const EstimatorSet set(build_estimators(*layout, scene.model(), settings), scene.gain, scene.bias);
  const std::vector<Frame> frames = frames_of(scene, layout, EstimatorSet::kMaxBatch, spoilt);
  std::uint32_t flags = 0;
  for (std::size_t size = 1; size <= frames.size(); ++size) {
    const Comparison seen = compare(set, std::span(frames).last(size));
    EXPECT_EQ(seen.fluxes, size * set.size());
    flags |= seen.flags;
  }
  if (spoilt == Spoilt::kNone) return;
  std::uint32_t expected = measurement_flag::kSaturated | measurement_flag::kBadPixel | measurement_flag::kOutside;
  if (background == BackgroundMethod::kLocal)
    expected |= measurement_flag::kNoBackground | measurement_flag::kSpoiltBackground;
  EXPECT_EQ(flags & expected, expected) << "the frames were to have every kind of flag";
}

INSTANTIATE_TEST_SUITE_P(
    All, EstimatorBatch,
    testing::Combine(testing::Values(PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted),
                     testing::Values(BackgroundMethod::kKnown, BackgroundMethod::kLocal),
                     testing::Values(Spoilt::kNone, Spoilt::kTheSameInAllFrames, Spoilt::kInEveryOtherFrame)));

TEST(EstimatorBatchOnAnyProcessor, HasTheBitsOfSingleFrames) {
  PhotometrySettings settings;
  settings.method = PhotometryMethod::kWeighted;
  settings.background = BackgroundMethod::kLocal;
  const test::GroundScene scene = crowded_scene();
  const auto layout = test::full_frame(kColumns, kRows);
  const EstimatorSet set(build_estimators(*layout, scene.model(), settings), scene.gain, scene.bias);
  const std::vector<Frame> frames = frames_of(scene, layout, EstimatorSet::kMaxBatch, Spoilt::kTheSameInAllFrames);
  for (const std::string& target : vector_targets()) {
    force_vector_target(target);
    SCOPED_TRACE(target);
    for (const std::size_t size : {3U, 8U, 15U}) compare(set, std::span(frames).first(size));
  }
  force_vector_target({});
}

TEST(EstimatorBatchOfWindows, HasTheBitsOfSingleFrames) {
  const test::GroundScene scene = crowded_scene();
  std::vector<Rectangle> regions;
  // Not in the order of the targets, so that pixels are read far from where the target before had its own.
  for (std::size_t i = 0; i < 90; ++i)
    regions.push_back(intersect(mask_window(scene.stars[(i * 37) % 90].position, 20), {0, 0, kColumns, kRows}));
  const auto layout = std::make_shared<const PixelLayout>(regions);
  PhotometrySettings settings;
  settings.background = BackgroundMethod::kLocal;
  const EstimatorSet set(build_estimators(*layout, scene.model(), settings), scene.gain, scene.bias);
  const std::vector<Frame> frames = frames_of(scene, layout, 7, Spoilt::kInEveryOtherFrame);
  EXPECT_EQ(compare(set, frames).fluxes, 7 * set.size());
}

TEST(EstimatorBatchOfFewStars, HasTheBitsOfSingleFrames) {
  // Two stars in a large frame: not worth interleaving it.
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.add_target({50.2, 60.7}, 1e5);
  scene.add_target({150.9, 20.1}, 3e4);
  const auto layout = test::full_frame(200, 100);
  for (const BackgroundMethod background : {BackgroundMethod::kKnown, BackgroundMethod::kLocal}) {
    PhotometrySettings settings;
    settings.background = background;
    const EstimatorSet set(build_estimators(*layout, scene.model(), settings), scene.gain, scene.bias);
    EXPECT_EQ(compare(set, frames_of(scene, layout, 5, Spoilt::kInEveryOtherFrame)).fluxes, 10U);
  }
}

TEST(EstimatorBatchOfNothing, MeasuresNothing) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  const auto layout = test::full_frame(8, 8);
  const EstimatorSet none(build_estimators(*layout, scene.model(), PhotometrySettings{}), scene.gain, scene.bias);
  EXPECT_EQ(compare(none, frames_of(scene, layout, 5, Spoilt::kNone)).fluxes, 0U);
  scene.add_target({-50.0, 3.0}, 1e4);
  const EstimatorSet outside(build_estimators(*layout, scene.model(), PhotometrySettings{}), scene.gain, scene.bias);
  EXPECT_EQ(compare(outside, frames_of(scene, layout, 5, Spoilt::kNone)).fluxes, 5U);
}

TEST(EstimatorBatchOfNothing, RefusesNoFramesAndTooMany) {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(0.6);
  scene.add_target({4.0, 4.0}, 1e4);
  const auto layout = test::full_frame(8, 8);
  const EstimatorSet set(build_estimators(*layout, scene.model(), PhotometrySettings{}), scene.gain, scene.bias);
  const std::vector<Frame> frames = frames_of(scene, layout, EstimatorSet::kMaxBatch + 1, Spoilt::kNone);
  EstimatorSet::BatchScratch scratch;
  const auto ignore = [](std::size_t, std::span<const double>, std::span<const std::uint32_t>) {};
  EXPECT_THROW(set.apply_batch({}, scratch, ignore), BugError);
  EXPECT_THROW(set.apply_batch(frames, scratch, ignore), BugError);
}

}  // namespace
}  // namespace astroid
