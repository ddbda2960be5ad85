#include "astroid/photometry/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr Rectangle kDetector{0, 0, 20, 30};
constexpr double kBias = 1000.0;

CalibrationModel plain_model() {
  CalibrationModel model;
  model.detector = kDetector;
  model.gain = Gain(25.0);
  model.bias = Adu(kBias);
  model.readout_noise = Electrons(50.0);
  return model;
}

// Two windows, the prescan beside them, the overscan of their columns.
std::shared_ptr<const PixelLayout> windows() {
  return std::make_shared<const PixelLayout>(std::vector<Rectangle>{
      {2, 5, 6, 6}, {12, 20, 6, 6}, {-5, 5, 5, 6}, {-5, 20, 5, 6}, {2, 30, 6, 4}, {12, 30, 6, 4}, {20, 5, 3, 21}});
}

// A signal that tells every pixel apart, the same in all rows of the overscan.
double signal_of(const Rectangle& region, int x, int y) {
  if (x < 0 || x >= kDetector.nx) return 0.0;
  return y >= kDetector.ny ? 10.0 * x : 10.0 * x + 100.0 + 7.0 * (y - region.y0);
}

template <class Change>
Frame frame_with(const std::shared_ptr<const PixelLayout>& layout, Change&& counts) {
  Frame frame = test::empty_frame(layout, Gain(25.0), Adu(kBias));
  for (std::size_t r = 0; r < layout->regions().size(); ++r) {
    const Rectangle& area = layout->regions()[r];
    for (int y = area.y0; y < area.y1(); ++y)
      for (int x = area.x0; x < area.x1(); ++x)
        frame.pixels.view(r).at(x, y) = static_cast<float>(counts(x, y, signal_of(area, x, y)));
  }
  return frame;
}

template <class Expected>
void expect_pixels(const Frame& frame, Expected&& expected, double tolerance) {
  for (std::size_t r = 0; r < 2; ++r) {
    const Rectangle& area = frame.pixels.layout().regions()[r];
    for (int y = area.y0; y < area.y1(); ++y)
      for (int x = area.x0; x < area.x1(); ++x)
        EXPECT_NEAR(frame.pixels.view(r).at(x, y), expected(area, x, y), tolerance) << x << "," << y;
  }
}

TEST(FrameCalibration, LeavesFramesAloneUnlessAskedTo) {
  const auto layout = windows();
  const FrameCalibration calibration(*layout, plain_model());
  EXPECT_TRUE(calibration.does_nothing());
  EXPECT_EQ(calibration.overscan_rows(), 0);
  EXPECT_EQ(calibration.bias_variance(), 0.0);
  const auto counts = [](int, int, double signal) { return kBias + signal; };
  Frame frame = frame_with(layout, counts);
  FrameCalibration::Scratch scratch;
  calibration.apply(frame, scratch);
  const Frame before = frame_with(layout, counts);
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) EXPECT_EQ(frame.pixels.pixels()[i], before.pixels.pixels()[i]);
}

TEST(FrameCalibration, SubtractsTheLevelOfEachColumn) {
  const auto layout = windows();
  CalibrationModel model = plain_model();
  model.subtract_smearing = true;
  const FrameCalibration calibration(*layout, model);
  EXPECT_EQ(calibration.overscan_rows(), 4);
  Frame frame = frame_with(layout, [](int, int, double signal) { return kBias + signal; });
  FrameCalibration::Scratch scratch;
  calibration.apply(frame, scratch);
  expect_pixels(
      frame, [](const Rectangle& area, int, int y) { return kBias + 100.0 + 7.0 * (y - area.y0); }, 1e-3);
}

TEST(FrameCalibration, SubtractsTheLevelOfEachHalfOfAColumn) {
  // A window across the middle; overscan of the lower half below, of the upper half above.
  const auto layout = std::make_shared<const PixelLayout>(std::vector<Rectangle>{
      {2, 12, 6, 6}, {12, 20, 6, 6}, {2, 30, 6, 4}, {2, -4, 6, 4}, {12, 30, 6, 4}, {12, -4, 6, 4}});
  CalibrationModel model = plain_model();
  model.subtract_smearing = true;
  model.nodes = 4;
  const FrameCalibration calibration(*layout, model);
  EXPECT_EQ(calibration.overscan_rows(), 4);
  const auto smeared = [](int x, int y) { return y >= 15 ? 10.0 * x : 300.0 - 7.0 * x; };
  Frame frame = frame_with(layout, [&](int x, int y, double) {
    const bool light = y >= 0 && y < kDetector.ny;
    return kBias + smeared(x, y) + (light ? 100.0 + y : 0.0);
  });
  FrameCalibration::Scratch scratch;
  calibration.apply(frame, scratch);
  expect_pixels(
      frame, [](const Rectangle&, int, int y) { return kBias + 100.0 + y; }, 1e-3);
}

TEST(FrameCalibration, MeasuresTheBiasInThePrescan) {
  const auto layout = windows();
  CalibrationModel model = plain_model();
  model.measure_bias = true;
  const FrameCalibration calibration(*layout, model);
  EXPECT_DOUBLE_EQ(calibration.bias_variance(), (2500.0 + 625.0 / 12.0) / 60.0);
  constexpr double kDrift = 3.25;
  Frame frame = frame_with(layout, [](int, int, double signal) { return kBias + kDrift + signal; });
  FrameCalibration::Scratch scratch;
  calibration.apply(frame, scratch);
  expect_pixels(
      frame, [](const Rectangle& area, int x, int y) { return kBias + signal_of(area, x, y); }, 1e-3);
}

TEST(FrameCalibration, StraightensEachNodeWithItsOwnBiasAndGain) {
  const auto layout = windows();
  CalibrationModel model = plain_model();
  model.nodes = 2;
  model.measure_bias = true;
  model.response = {.a0 = 0.5, .a1 = -0.01, .a2 = 1e-6};
  model.gain_factors = {1.0, 1.03, 1.0, 1.0};
  const FrameCalibration calibration(*layout, model);
  const auto bias = [](int x) { return x >= 10 ? kBias - 20.0 : kBias + 4.0; };
  const auto factor = [](int x) { return x >= 10 ? 1.03 : 1.0; };
  Frame frame =
      frame_with(layout, [&](int x, int, double signal) { return bias(x) + model.response.out(signal / factor(x)); });
  FrameCalibration::Scratch scratch;
  calibration.apply(frame, scratch);
  expect_pixels(
      frame, [](const Rectangle& area, int x, int y) { return kBias + signal_of(area, x, y); }, 1e-3);
}

TEST(FrameCalibration, SaysWhichReferencePixelsAreMissing) {
  const PixelLayout bare({{2, 5, 6, 6}});
  CalibrationModel model = plain_model();
  model.measure_bias = true;
  EXPECT_THROW(FrameCalibration(bare, model), InputError);
  model.measure_bias = false;
  model.subtract_smearing = true;
  EXPECT_THROW(FrameCalibration(bare, model), InputError);
  // With two nodes, both sides are wanted.
  const PixelLayout left({{2, 5, 12, 6}, {-5, 5, 5, 6}});
  model.subtract_smearing = false;
  model.measure_bias = true;
  EXPECT_NO_THROW(FrameCalibration(left, model));
  model.nodes = 2;
  EXPECT_THROW(FrameCalibration(left, model), InputError);
}

TEST(FrameCalibration, NeedsNoBiasOfNodesThatReadNothing) {
  const PixelLayout lower({{2, 5, 6, 6}}, {{-5, 5, 5, 6}, {20, 5, 5, 6}});  // the upper half is not computed
  CalibrationModel model = plain_model();
  model.nodes = 4;
  model.measure_bias = true;
  EXPECT_DOUBLE_EQ(FrameCalibration(lower, model).bias_variance(), (2500.0 + 625.0 / 12.0) / 30.0);
}

TEST(ReadoutNodes, CoverEveryPixelOnce) {
  for (const int count : {1, 2, 4}) {
    const ReadoutNodes nodes(kDetector, count);
    for (int y = -1; y <= kDetector.ny; ++y) {
      int next = -3;
      for_each_node(nodes, y, -3, 25, [&](int node, int x0, int x1) {
        EXPECT_EQ(x0, next);
        EXPECT_LT(x0, x1);
        for (int x = x0; x < x1; ++x) EXPECT_EQ(nodes.of(x, y), node);
        next = x1;
      });
      EXPECT_EQ(next, 25);
    }
  }
}

}  // namespace
}  // namespace astroid
