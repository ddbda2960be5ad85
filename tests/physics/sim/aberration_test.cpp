// Kinematic aberration against the exact formula, and the velocity of the Earth against a Kepler orbit.
#include "astroid/sim/aberration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "astroid/core/sphere.hpp"

namespace astroid {
namespace {

double length(const Velocity& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// Heliocentric position of the Earth-Moon barycentre in au by Kepler's equation, equatorial.
Velocity kepler_position(double mjd) {
  const double t = (mjd - 51544.5) / 36525.0;
  const double radian = std::acos(-1.0) / 180.0;
  const double e = 0.01671123;
  const double perihelion = radian * (102.93768193 + 0.32327364 * t);
  const double mean = radian * (100.46457166 + 35999.37244981 * t) - perihelion;
  double anomaly = mean;
  for (int i = 0; i < 50; ++i) anomaly = mean + e * std::sin(anomaly);
  const double x = std::cos(anomaly) - e;
  const double y = std::sqrt(1.0 - e * e) * std::sin(anomaly);
  const double ex = x * std::cos(perihelion) - y * std::sin(perihelion);
  const double ey = x * std::sin(perihelion) + y * std::cos(perihelion);
  const double obliquity = radian * 23.43928;
  return {ex, ey * std::cos(obliquity), ey * std::sin(obliquity)};
}

TEST(Aberration, VelocityIsTheDerivativeOfAKeplerOrbit) {
  constexpr double kAuPerDayInC = 149597870.7 / 86400.0 / 299792.458;
  double worst = 0.0;
  for (double mjd = 61406.0; mjd < 61406.0 + 800.0; mjd += 7.3) {
    const Velocity v = spacecraft_velocity(mjd);
    const Velocity before = kepler_position(mjd - 0.5);
    const Velocity after = kepler_position(mjd + 0.5);
    double error = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double expected = 1.01004 * (after[i] - before[i]) * kAuPerDayInC;
      error += (v[i] - expected) * (v[i] - expected);
    }
    worst = std::max(worst, std::sqrt(error) / length(v));
  }
  std::printf("largest relative error of the velocity: %.2g\n", worst);
  EXPECT_LT(worst, 1e-4);
}

TEST(Aberration, EarthIsFastInJanuaryAndMovesAwayFromTheMarchSun) {
  double fastest = 0.0;
  double when = 0.0;
  for (double mjd = 61406.0; mjd < 61406.0 + 365.25; mjd += 0.25)
    if (length(spacecraft_velocity(mjd)) > fastest) {
      fastest = length(spacecraft_velocity(mjd));
      when = mjd;
    }
  const double km = 299792.458 / 1.01004;
  EXPECT_NEAR(fastest * km, 30.29, 0.01);  // km/s at perihelion
  EXPECT_NEAR(when, 61408.0, 2.0);         // 2027 January 3; the Moon moves the date by up to two days
  // At the March equinox (2027 March 20, 20:25 UT) the Sun is at right ascension 0, the Earth opposite: it moves
  // towards right ascension 270 deg, declination -23.4 deg, the equinox of date being 0.38 deg from that of J2000.
  const Velocity v = spacecraft_velocity(61484.851);
  // The ellipse adds 0.0167 of the speed at a right angle to its long axis, which points to 103 deg.
  const double degree = std::acos(-1.0) / 180.0;
  EXPECT_NEAR(v[0] / length(v), -std::sin(0.378 * degree) - 0.0167 * std::sin(103.0 * degree), 3e-4);
  EXPECT_NEAR(v[2] / v[1], std::tan(23.439 * std::acos(-1.0) / 180.0), 1e-4);
  EXPECT_LT(v[1], 0.0);
}

/// The apparent direction in a moving frame, exact.
Direction apparent(SkyPosition star, const Velocity& v) {
  const Direction n = to_direction(star);
  const double dot = n.x * v[0] + n.y * v[1] + n.z * v[2];
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const double inverse_gamma = std::sqrt(1.0 - square);
  const double factor = 1.0 + dot / (1.0 + inverse_gamma);
  return {(inverse_gamma * n.x + factor * v[0]) / (1.0 + dot), (inverse_gamma * n.y + factor * v[1]) / (1.0 + dot),
          (inverse_gamma * n.z + factor * v[2]) / (1.0 + dot)};
}

double distance(PixelPosition a, PixelPosition b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

TEST(Aberration, MovesStarsAsTheExactFormulaDoes) {
  for (const double roll : {0.0, 37.0}) {
    const CameraPointing pointing{.axis = {95.3, -47.9}, .roll = Degrees(roll), .scale = PixelScale(15.0)};
    const SkyProjection camera(pointing);
    std::vector<SkyPosition> stars{pointing.axis};
    for (const double radius : {2.0, 8.0, 15.0})
      for (int i = 0; i < 8; ++i) {
        const double angle = i * std::acos(-1.0) / 4.0;
        stars.push_back(
            inverse_gnomonic({radius * std::cos(angle) * 1.1, radius * std::sin(angle) * 1.1}, pointing.axis));
      }
    for (const double mjd : {61406.0, 61500.0, 61590.0}) {
      const Velocity v = spacecraft_velocity(mjd);
      // The camera follows the apparent boresight. Which way it is rolled then is a convention; distances do not tell.
      CameraPointing followed = pointing;
      followed.axis = to_sky_position(apparent(pointing.axis, v));
      const SkyProjection moved(followed);
      std::vector<PixelPosition> before;
      std::vector<PixelPosition> linear;
      std::vector<PixelPosition> exact;
      double turned = 0.0;
      for (const SkyPosition& star : stars) {
        const PixelPosition p = *camera.to_pixel(star);
        const PixelShift shift =
            aberration_jacobian(star, {pointing.axis, pointing.roll}, *camera.attitude_jacobian(star)).displacement(v);
        before.push_back(p);
        linear.push_back({p.x + shift.dx, p.y + shift.dy});
        exact.push_back(*moved.to_pixel(to_sky_position(apparent(star, v))));
        turned += p.x * shift.dy - p.y * shift.dx;
      }
      double worst = 0.0;
      double largest = 0.0;
      for (std::size_t i = 0; i < stars.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          worst = std::max(worst, std::abs(distance(linear[i], linear[j]) - distance(exact[i], exact[j])));
          largest = std::max(largest, std::abs(distance(before[i], before[j]) - distance(exact[i], exact[j])));
        }
      std::printf("roll %.0f, MJD %.0f: distances change by up to %.4f px, the first order misses %.2g px\n", roll, mjd,
                  largest, worst);
      EXPECT_NEAR(distance(linear[0], before[0]), 0.0, 1e-9);  // the boresight stays
      EXPECT_GT(largest, 0.05);
      EXPECT_LT(worst, 1e-4);
      // No roll: the sum of position x displacement over rings of stars vanishes, to the order of the perspective.
      EXPECT_LT(std::abs(turned), 1e-3 * largest * 24.0 * 2000.0);
    }
  }
}

TEST(Aberration, IsLinearInTheVelocityAndZeroBehindTheCamera) {
  const CameraPointing pointing{.axis = {10.0, 80.0}, .scale = PixelScale(15.0)};
  const SkyProjection camera(pointing);
  const SkyPosition star{30.0, 75.0};
  const AberrationJacobian j =
      aberration_jacobian(star, {pointing.axis, pointing.roll}, *camera.attitude_jacobian(star));
  const PixelShift one = j.displacement({1e-5, -2e-5, 3e-5});
  const PixelShift two = j.displacement({2e-5, -4e-5, 6e-5});
  EXPECT_DOUBLE_EQ(two.dx, 2.0 * one.dx);
  EXPECT_DOUBLE_EQ(two.dy, 2.0 * one.dy);
  EXPECT_EQ(j.displacement({}).dx, 0.0);
  const AberrationJacobian behind = aberration_jacobian({10.0, -60.0}, {pointing.axis, pointing.roll}, {});
  EXPECT_EQ(behind.displacement({1e-4, 1e-4, 1e-4}).dx, 0.0);
}

}  // namespace
}  // namespace astroid
