// The attitude that images show, against the attitude that they were made with.
#include "astroid/photometry/attitude_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "astroid/photometry/attitude_response.hpp"
#include "astroid/test/ground_scene.hpp"

namespace astroid {
namespace {

constexpr int kSide = 128;
constexpr double kScale = 15.0;  // arcsec per px
const Attitude kReach{0.2, 0.2, 20.0};

/// Of a star in a tangential projection about the middle of the frame, to first order in its distance.
AttitudeJacobian motion_of(const FieldStar& star) {
  constexpr double kRadian = 206264.806;
  return {.dx_dyaw = 1.0 / kScale,
          .dx_droll = -(star.position.y - kSide / 2) / kRadian,
          .dy_dpitch = 1.0 / kScale,
          .dy_droll = (star.position.x - kSide / 2) / kRadian};
}

class AttitudeSensor : public testing::Test {
 protected:
  AttitudeSensor() {
    scene_.psf = make_gaussian_psf(0.7);
    scene_.gain = Gain(25.0);
    scene_.bias = Adu(1000.0);
    scene_.noise = {945.0, 50.2, 0.0};
    const test::TestNoise places(3);
    for (std::uint32_t i = 0; i < 60; ++i)
      scene_.add_target({5.0 + 118.0 * places.uniform(0, i), 5.0 + 118.0 * places.uniform(1, i)},
                        2e4 * std::pow(50.0, places.uniform(2, i)));
    for (std::size_t i = 0; i < scene_.stars.size(); ++i) guides_.push_back({i, motion_of(scene_.stars[i])});
  }

  [[nodiscard]] std::vector<double> light(const Attitude& attitude) const {
    test::GroundScene moved = scene_;
    for (FieldStar& star : moved.stars) {
      const PixelShift shift = displacement(motion_of(star), attitude);
      star.position = {star.position.x + shift.dx, star.position.y + shift.dy};
    }
    return test::expected_electrons(*layout_, moved);
  }
  [[nodiscard]] astroid::AttitudeSensor sensor() const {
    return {*layout_, scene_.model(), settings_, guides_, kReach};
  }

  test::GroundScene scene_;
  std::vector<GuideStar> guides_;
  PhotometrySettings settings_;
  std::shared_ptr<const PixelLayout> layout_ = test::full_frame(kSide, kSide);
};

TEST_F(AttitudeSensor, MeasuresAsWellAsItSays) {
  constexpr std::uint32_t kFrames = 400;
  const Attitude truth{0.05, -0.03, 4.0};
  const std::vector<double> expected = light(truth);
  const test::TestNoise noise(11);
  const auto sensor = this->sensor();
  std::cout << sensor.guides() << " guide stars\n";
  ASSERT_GT(sensor.guides(), 30U) << "of sixty, some of which share pixels";
  const AttitudeCovariance error = sensor.covariance();
  double yaw = 0.0;
  double yaw2 = 0.0;
  double pitch2 = 0.0;
  double roll2 = 0.0;
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    const MeasuredAttitude measured = sensor.measure(test::noisy_frame(layout_, scene_, expected, noise, k));
    ASSERT_EQ(measured.guides, sensor.guides()) << "no star contradicts the others";
    const auto pull = [](double difference, double variance) { return difference / std::sqrt(variance); };
    const double y = pull(measured.mean.yaw - truth.yaw, error.yaw_yaw);
    yaw += y / kFrames;
    yaw2 += y * y / kFrames;
    pitch2 += std::pow(pull(measured.mean.pitch - truth.pitch, error.pitch_pitch), 2) / kFrames;
    roll2 += std::pow(pull(measured.mean.roll - truth.roll, error.roll_roll), 2) / kFrames;
  }
  std::cout << "mean pull " << yaw << ", variances " << yaw2 << ", " << pitch2 << ", " << roll2 << "; sigma "
            << std::sqrt(error.yaw_yaw) << " arcsec of yaw, " << std::sqrt(error.roll_roll) << " of roll\n";
  EXPECT_NEAR(yaw, 0.0, 4.0 / std::sqrt(kFrames));
  for (const double variance : {yaw2, pitch2, roll2}) EXPECT_NEAR(variance, 1.0, 4.0 * std::sqrt(2.0 / kFrames));
  // Sixty stars of 2e4 to 1e6 e- give the pointing to well below a hundredth of a pixel.
  EXPECT_LT(std::sqrt(error.yaw_yaw), 0.002 * kScale);
}

TEST_F(AttitudeSensor, IsLinearForSmallDisplacements) {
  // Expecting much leaves the prior without weight.
  const astroid::AttitudeSensor sensor(*layout_, scene_.model(), settings_, guides_, {20.0, 20.0, 2000.0});
  struct Row {
    double pixels, bound;
  };
  for (const Row& row : {Row{0.01, 3e-4}, Row{0.04, 5e-4}, Row{0.1, 3e-3}}) {
    const double yaw = row.pixels * kScale;
    const MeasuredAttitude measured =
        sensor.measure(test::frame_of(layout_, scene_, light({.yaw = yaw, .pitch = -0.5 * yaw})));
    const double error = std::abs(measured.mean.yaw / yaw - 1.0);
    std::cout << row.pixels << " px: relative error " << error << '\n';
    EXPECT_LT(error, row.bound) << row.pixels;
  }
}

TEST_F(AttitudeSensor, LeavesOutStarsThatContradictTheOthersOrAreSaturated) {
  const auto sensor = this->sensor();
  const Attitude truth{0.05, -0.03, 0.0};
  Frame frame = test::frame_of(layout_, scene_, light(truth));
  const MeasuredAttitude undisturbed = sensor.measure(frame);
  const auto pixel_of = [&](std::size_t star) {
    const PixelPosition p = scene_.stars[star].position;
    return static_cast<std::size_t>(std::lround(p.y)) * kSide + static_cast<std::size_t>(std::lround(p.x));
  };
  frame.pixels.pixels()[pixel_of(3) + 1] += 4000.0F;  // 1e5 e- of a particle
  frame.pixels.pixels()[pixel_of(8) - kSide] += 40000.0F;
  frame.flags.pixels()[pixel_of(20)] = pixel_flag::kFullWell;
  const MeasuredAttitude measured = sensor.measure(frame);
  EXPECT_LE(measured.guides, undisturbed.guides - 3);
  EXPECT_GE(measured.guides, undisturbed.guides - 6) << "some stars share the pixels of those";
  const double sigma = std::sqrt(sensor.covariance().yaw_yaw);
  EXPECT_NEAR(measured.mean.yaw, undisturbed.mean.yaw, 0.1 * sigma);
  EXPECT_NEAR(measured.mean.pitch, undisturbed.mean.pitch, 0.1 * sigma);
}

TEST_F(AttitudeSensor, SaysNothingOfAxesThatDoNotMoveOrAreNotSeen) {
  const astroid::AttitudeSensor fixed(*layout_, scene_.model(), settings_, guides_, {.yaw = 0.2});
  const MeasuredAttitude measured = fixed.measure(test::frame_of(layout_, scene_, light({.yaw = 0.05})));
  EXPECT_NEAR(measured.mean.yaw, 0.05, 1e-4);
  EXPECT_EQ(measured.mean.pitch, 0.0);
  EXPECT_EQ(measured.mean.roll, 0.0);
  const astroid::AttitudeSensor blind(*layout_, scene_.model(), settings_, {}, kReach);
  EXPECT_EQ(blind.measure(test::frame_of(layout_, scene_, light({}))).guides, 0);
  EXPECT_DOUBLE_EQ(blind.covariance().yaw_yaw, kReach.yaw * kReach.yaw) << "what was expected is all that is known";
}

TEST_F(AttitudeSensor, TakesJitterOutOfFluxes) {
  settings_.background = BackgroundMethod::kKnown;
  settings_.method = PhotometryMethod::kMask;
  const auto estimators = build_estimators(*layout_, scene_.model(), settings_);
  const EstimatorSet set(estimators, scene_.gain, scene_.bias);
  const Attitude truth{0.09, -0.06, 5.0};
  const Frame frame = test::frame_of(layout_, scene_, light(truth));
  std::vector<double> flux(set.size());
  std::vector<std::uint32_t> flags(set.size());
  set.apply(frame, flux, flags);
  const MeasuredAttitude measured = sensor().measure(frame);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double deviation = flux[i] / (estimators[i].budget.target + estimators[i].budget.contaminants) - 1.0;
    const AttitudeResponse response = attitude_response(estimators[i], guides_[i].motion);
    before = std::max(before, std::abs(deviation));
    after = std::max(after, std::abs(without_attitude(deviation, response, measured.mean)));
  }
  std::cout << "largest deviation " << before << " before, " << after << " after\n";
  EXPECT_GT(before, 1e-3);
  EXPECT_LT(after, 0.05 * before);
}

}  // namespace
}  // namespace astroid
