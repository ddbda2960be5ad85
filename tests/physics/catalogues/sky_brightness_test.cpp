// The sky between the stars: known directions and seasons, and its conversion to detected electrons.
#include "astroid/catalogues/sky_brightness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "astroid/core/ecliptic.hpp"
#include "astroid/core/error.hpp"

namespace astroid {
namespace {

TEST(Coordinates, OfKnownDirections) {
  // The ecliptic's pole and origin, and the galactic centre and pole (J2000).
  EXPECT_NEAR(to_ecliptic({270.0, 66.56072}).latitude.value(), 90.0, 1e-9);
  EXPECT_NEAR(to_ecliptic({0.0, 0.0}).longitude.value(), 0.0, 1e-9);
  EXPECT_NEAR(to_ecliptic({90.0, 23.43928}).longitude.value(), 90.0, 1e-9);
  EXPECT_NEAR(to_ecliptic({90.0, 23.43928}).latitude.value(), 0.0, 1e-9);
  EXPECT_NEAR(to_galactic({192.85948, 27.12825}).latitude.value(), 90.0, 1e-6);
  const SphericalPosition centre = to_galactic({266.40500, -28.93617});
  EXPECT_NEAR(centre.latitude.value(), 0.0, 1e-3);
  EXPECT_NEAR(std::remainder(centre.longitude.value(), 360.0), 0.0, 1e-3);
  // The Crab nebula, 05h34m31.94s +22 00' 52.2": l = 184.5575, b = -5.7843 (SIMBAD).
  const SphericalPosition crab = to_galactic({83.63308, 22.01450});
  EXPECT_NEAR(crab.longitude.value(), 184.5575, 1e-3);
  EXPECT_NEAR(crab.latitude.value(), -5.7843, 1e-3);
}

TEST(ZodiacalLight, HasTheBrightnessOfTheTable) {
  EXPECT_NEAR(zodiacal_light(Degrees(180.0), Degrees(0.0)).value, 180.0, 0.4);    // gegenschein: 180 S10
  EXPECT_NEAR(zodiacal_light(Degrees(10.0), Degrees(90.0)).value, 60.0, 0.4);     // pole: 60 S10
  EXPECT_NEAR(zodiacal_light(Degrees(-90.0), Degrees(0.0)).value, 202.0, 0.5);    // 202 S10
  EXPECT_NEAR(zodiacal_light(Degrees(270.0), Degrees(-30.0)).value, 103.0, 0.5);  // both signs
  // Between nodes it stays between them.
  const double between = zodiacal_light(Degrees(97.0), Degrees(12.0)).value;
  EXPECT_LT(between, zodiacal_light(Degrees(90.0), Degrees(10.0)).value);
  EXPECT_GT(between, zodiacal_light(Degrees(105.0), Degrees(15.0)).value);
  EXPECT_THROW((void)zodiacal_light(Degrees(3.0), Degrees(2.0)), InputError);
}

TEST(ZodiacalLight, FollowsTheSeasons) {
  // On the ecliptic at longitude 180: opposite the Sun at the March equinox, 90 deg from it in June.
  const SkyPosition place{180.0, 0.0};
  EXPECT_NEAR(zodiacal_light(place, 61484.85).value, 180.0, 2.0);
  EXPECT_NEAR(zodiacal_light(place, 61484.85 + 92.8).value, 202.0, 4.0);
  // The same a year later.
  EXPECT_NEAR(zodiacal_light(place, 61484.85 + 365.2564).value / zodiacal_light(place, 61484.85).value, 1.0, 1e-3);
}

TEST(UnresolvedStarlight, IsBrightInThePlaneAndFaintAtThePole) {
  const double centre = unresolved_starlight({266.40500, -28.93617}).value;
  const double anticentre = unresolved_starlight({86.405, 28.936}).value;
  const double pole = unresolved_starlight({192.85948, 27.12825}).value;
  std::printf("unresolved stars: %.0f S10 at the centre, %.1f at the anticentre, %.2g at the pole\n", centre,
              anticentre, pole);
  // I = 18.973 mag per square arcsec at the origin of the fit, V = 19.673: 3600² 10^(-0.4 (19.673 - 10)) S10.
  EXPECT_NEAR(centre / (3600.0 * 3600.0 * std::pow(10.0, -0.4 * 9.67338)), 1.0, 0.01);
  EXPECT_LT(anticentre, 0.05 * centre);
  EXPECT_LT(pole, 1e-3 * anticentre);
}

TEST(SkyRate, TurnsS10IntoElectrons) {
  Mission mission;
  mission.ccd.pixel_scale = PixelScale(15.0);
  mission.telescope.zero_point = Magnitude(20.62);
  mission.telescope.zero_point_passband = "V";
  const double solid_angle = (15.0 / 3600.0) * (15.0 / 3600.0);
  EXPECT_NEAR(rate_of_one_s10(mission).value(), solid_angle * std::pow(10.0, 0.4 * 10.62), 1e-9);
  mission.telescope.zero_point_passband = "P";  // the Sun is 0.378 mag brighter there
  EXPECT_NEAR(rate_of_one_s10(mission).value() / (solid_angle * std::pow(10.0, 0.4 * 10.62)),
              std::pow(10.0, 0.4 * 0.3776), 1e-3);
  // PLATO's southern field, 15 arcsec/px: the normal cameras expect about 45 to 60 e-/px/s with the stars in it.
  mission.field.sky = SkyModel::kZodiacal;
  mission.satellite.ra = Degrees(95.3104);
  mission.satellite.dec = Degrees(-47.8869);
  const double rate = mean_background_rate(mission).value();
  std::printf("PLATO's southern field: %.1f e-/px/s\n", rate);
  EXPECT_GT(rate, 25.0);
  EXPECT_LT(rate, 60.0);
  mission.field.stray_light.level = ElectronsPerSecond(64.0);
  EXPECT_NEAR(mean_background_rate(mission).value(), rate + 64.0, 1e-12);
  mission.field.unresolved_stars = 30.0;
  EXPECT_GT(mean_background_rate(mission).value(), rate + 64.0 + 10.0);
  mission.field.sky = SkyModel::kConstant;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  EXPECT_EQ(mean_background_rate(mission).value(), 109.0);
}

}  // namespace
}  // namespace astroid
