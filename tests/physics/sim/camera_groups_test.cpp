// What cameras of different groups see: stars where a tilted camera has them, moved by the attitude that all share.
#include "astroid/core/camera_groups.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "astroid/sim/optics.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

Mission tilted_mission() {
  Mission mission = test::bare_mission(4510, 4510);
  mission.satellite.roll = Degrees(25.0);
  mission.ccd.axis_x = mission.ccd.axis_y = 4565.0;
  mission.telescope.cameras = 4;
  mission.telescope.groups.cameras = {1, 1, 1, 1};
  mission.telescope.groups.tilt = {9.2, 9.2, 9.2, 9.2};
  mission.telescope.groups.azimuth = {45.0, 135.0, 225.0, 315.0};
  mission.telescope.groups.roll = {0.0, -90.0, -180.0, -270.0};
  return mission;
}

/// A star after the spacecraft has turned: `from` goes to `to` by the angle.
Direction turned(const Direction& star, const Direction& from, const Direction& to, Arcseconds angle) {
  const SineCosine turn = sine_cosine(to_degrees(angle));
  const double a = dot(star, from);
  const double b = dot(star, to);
  const double da = turn.cosine * a - turn.sine * b - a;
  const double db = turn.sine * a + turn.cosine * b - b;
  return {star.x + da * from.x + db * to.x, star.y + da * from.y + db * to.y, star.z + da * from.z + db * to.z};
}

TEST(CameraGroups, SeeTheSpacecraftTurnAboutItsOwnAxes) {
  const Mission mission = tilted_mission();
  const CameraAxes craft = camera_axes(spacecraft_boresight(mission));
  for (int g = 0; g < 4; ++g) {
    const SkyProjection camera = make_projection(group_mission(mission, g));
    for (const SkyPosition star : {SkyPosition{95.3104, -47.8869}, SkyPosition{99.0, -50.0}, camera.axis()}) {
      const AttitudeJacobian j = *camera.attitude_jacobian(star);
      constexpr double kAngle = 10.0;  // arcsec; central differences err by its square, 1e-9 relative
      const auto shift = [&](const Direction& from, const Direction& to) {
        const auto at = [&](double angle) {
          return *camera.to_pixel(to_sky_position(turned(to_direction(star), from, to, Arcseconds(angle))));
        };
        const PixelPosition plus = at(kAngle);
        const PixelPosition minus = at(-kAngle);
        return PixelShift{(plus.x - minus.x) / (2.0 * kAngle), (plus.y - minus.y) / (2.0 * kAngle)};
      };
      constexpr double kGrid = 2.0 * kPixelGrid / (2.0 * kAngle);
      const PixelShift yaw = shift(craft.axis, craft.x);
      const PixelShift pitch = shift(craft.axis, craft.y);
      const PixelShift roll = shift(craft.x, craft.y);
      EXPECT_NEAR(j.dx_dyaw, yaw.dx, kGrid);
      EXPECT_NEAR(j.dy_dyaw, yaw.dy, kGrid);
      EXPECT_NEAR(j.dx_dpitch, pitch.dx, kGrid);
      EXPECT_NEAR(j.dy_dpitch, pitch.dy, kGrid);
      EXPECT_NEAR(j.dx_droll, roll.dx, kGrid);
      EXPECT_NEAR(j.dy_droll, roll.dy, kGrid);
    }
    // On the axis a roll of the spacecraft is a motion by its sine of the tilt.
    const AttitudeJacobian axis = *camera.attitude_jacobian(camera.axis());
    EXPECT_NEAR(std::hypot(axis.dx_droll, axis.dy_droll), std::sin(9.2 * kPi / 180.0) / 15.0, 1e-8);
    // And where the spacecraft looks it does nothing.
    const AttitudeJacobian centre = *camera.attitude_jacobian({95.3104, -47.8869});
    EXPECT_NEAR(std::hypot(centre.dx_droll, centre.dy_droll), 0.0, 1e-8);
  }
}

TEST(CameraGroups, MountedAQuarterTurnApartHaveTheMiddleOfTheFieldOnTheSamePixel) {
  const Mission mission = tilted_mission();
  const double offset = std::tan(9.2 * kPi / 180.0) / (15.0 / 3600.0 * kPi / 180.0) / std::sqrt(2.0);
  for (int g = 0; g < 4; ++g) {
    const PixelPosition p = *make_projection(group_mission(mission, g)).to_pixel({95.3104, -47.8869});
    EXPECT_NEAR(p.x, 4565.0 - offset, 1e-6) << g;
    EXPECT_NEAR(p.y, 4565.0 - offset, 1e-6) << g;
  }
}

StarCatalogue one_star() {
  StarCatalogue catalogue = test::lab_catalogue({{15.0, 15.0, 1e6}});
  return catalogue;
}

StarCatalogue sky_star(const Mission& mission) {
  StarCatalogue catalogue = one_star();
  catalogue.positions = PositionKind::kSky;
  catalogue.stars[0].sky = {mission.satellite.ra.value(), mission.satellite.dec.value()};
  return catalogue;
}

Mission two_alike() {
  Mission mission = test::plato_mission(30, 30);
  mission.telescope.cameras = mission.telescope.simulated_cameras = 2;
  mission.telescope.groups.cameras = {1, 1};
  return mission;
}

TEST(CameraGroups, ShareTheAttitudeToTheBitWhereAxisAndTimeAreTheSame) {
  Mission mission = two_alike();
  mission.telescope.groups.stagger = {5.0, 5.0};
  mission.telescope.groups.offset_x = {0.0, 0.37};
  const Scene a(group_mission(mission, 0), sky_star(mission));
  const Scene b(group_mission(mission, 1), sky_star(mission));
  const auto in_a = a.attitude().sample(4, 6);
  const auto in_b = b.attitude().sample(4, 6);
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    const PixelShift first = displacement(a.stars()[0].motion, in_a[i]);
    const PixelShift second = displacement(b.stars()[0].motion, in_b[i]);
    EXPECT_EQ(first.dx, second.dx);
    EXPECT_EQ(first.dy, second.dy);
  }
}

TEST(CameraGroups, PutStarsOnTheirPixelPhaseAndPassTheirShareOfTheLight) {
  Mission mission = two_alike();
  mission.telescope.groups.offset_x = {0.0, 0.37};
  mission.telescope.groups.offset_y = {0.0, -0.21};
  mission.telescope.groups.throughput = {1.0, 0.9};
  mission.telescope.groups.end_of_life = {0.98, 0.95};
  mission.telescope.throughput.age_years = mission.telescope.throughput.lifetime_years = 6.5;
  const Scene a(group_mission(mission, 0), sky_star(mission));
  const Scene b(group_mission(mission, 1), sky_star(mission));
  EXPECT_NEAR(b.stars()[0].position.x - a.stars()[0].position.x, 0.37, kPixelGrid);
  EXPECT_NEAR(b.stars()[0].position.y - a.stars()[0].position.y, -0.21, kPixelGrid);
  EXPECT_NEAR(b.stars()[0].electrons / a.stars()[0].electrons, 0.9 * 0.95 / 0.98, 1e-7);
}

TEST(CameraGroups, BeginTheirExposuresLaterByTheStagger) {
  Mission mission = two_alike();
  mission.telescope.groups.stagger = {0.0, 6.25};
  const Scene a(group_mission(mission, 0), one_star());
  const Scene b(group_mission(mission, 1), one_star());
  EXPECT_EQ(a.mid_time(3), Seconds(3 * 25.0 + 10.5));
  EXPECT_EQ(b.mid_time(3), Seconds(3 * 25.0 + 10.5 + 6.25));
}

TEST(CameraGroups, OfAllCamerasMakeTheImagesOfAMissionWithoutGroups) {
  Mission with = test::plato_mission(30, 30);
  const Mission without = with;
  with.telescope.groups.cameras = {24};
  with.telescope.groups.tilt = with.telescope.groups.stagger = {0.0};
  const auto frame_of = [](const Mission& mission) {
    const auto scene = std::make_shared<const Scene>(mission, sky_star(mission));
    const Simulator simulator(scene, std::make_shared<const Plan>(make_plan(*scene)), 0);
    ExposureState state = simulator.make_state();
    simulator.simulate(2, state);
    const auto pixels = state.frame.pixels.pixels();
    return std::vector<float>(pixels.begin(), pixels.end());
  };
  EXPECT_EQ(frame_of(group_mission(with, 0)), frame_of(without));
}

TEST(CameraGroups, AreNotSeenAllAtOnce) {
  EXPECT_THROW(Scene(two_alike(), one_star()), BugError);
}

}  // namespace
}  // namespace astroid
