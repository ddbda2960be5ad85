#include "astroid/core/wcs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/test/plato_distortion.hpp"

namespace astroid {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

CameraPointing lops2(const std::string& code = "TAN", double roll = 0.0) {
  return {.axis = {95.3104, -47.8869},
          .roll = Degrees(roll),
          .scale = PixelScale(15.0),
          .axis_pixel = {2254.5, 2254.5},
          .projection = code};
}

std::string header_text(const std::vector<std::string>& cards) {
  std::string text;
  for (std::string card : cards) {
    card.resize(80, ' ');
    text += card;
  }
  return text;
}

std::string header_of(const SkyProjection& projection) {
  std::vector<std::string> cards = {"SIMPLE  =                    T", "BITPIX  =                   16",
                                    "NAXIS   =                    2", "NAXIS1  =                 4510",
                                    "NAXIS2  =                 4510"};
  for (const FitsCard& card : projection.fits_cards()) {
    std::string value;
    if (const auto* text = std::get_if<std::string>(&card.value)) value = fmt::format("'{}'", *text);
    if (const auto* number = std::get_if<double>(&card.value)) value = shortest_text(*number);
    if (const auto* number = std::get_if<std::int64_t>(&card.value)) value = std::to_string(*number);
    std::string key = card.key;
    key.resize(8, ' ');
    key += "= ";
    cards.push_back(key + value);
  }
  cards.emplace_back("END");
  return header_text(cards);
}

// x and y of a zenithal projection in pixels from its closed form. @source Calabretta2002 Eq. 54, 58, 63, 67, 69
PixelPosition closed_form(const CameraPointing& p, SkyPosition star) {
  const Direction n = to_direction(p.axis);
  const Direction s = to_direction(star);
  const double a = p.axis.ra * kPi / 180.0;
  const double d = p.axis.dec * kPi / 180.0;
  const double east = -std::sin(a) * s.x + std::cos(a) * s.y;
  const double north = -std::sin(d) * std::cos(a) * s.x - std::sin(d) * std::sin(a) * s.y + std::cos(d) * s.z;
  const double theta = angular_separation(p.axis, star).value() * kPi / 180.0;  // from the axis
  const double cosine = n.x * s.x + n.y * s.y + n.z * s.z;
  double radius = 0.0;
  if (p.projection == "TAN") radius = std::sin(theta) / cosine;
  if (p.projection == "SIN") radius = std::sin(theta);
  if (p.projection == "ARC") radius = theta;
  if (p.projection == "STG") radius = 2.0 * std::tan(theta / 2.0);
  if (p.projection == "ZEA") radius = 2.0 * std::sin(theta / 2.0);
  const double scale = 180.0 / kPi * 3600.0 / p.scale.value();  // px per rad
  const double length = std::hypot(east, north);
  const double u = length > 0.0 ? -radius * east / length * scale : 0.0;
  const double v = length > 0.0 ? radius * north / length * scale : 0.0;
  const double roll = p.roll.value() * kPi / 180.0;
  // Counter-clockwise by the roll.
  return {p.axis_pixel.x + u * std::cos(roll) - v * std::sin(roll),
          p.axis_pixel.y + u * std::sin(roll) + v * std::cos(roll)};
}

struct Turn {  // arcsec
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};

// The pointing after turning the camera by angles (arcsec) so that stars move by +yaw along x and +pitch along y.
// Composes the directions of the camera's own axes, independently of the code under test.
CameraPointing turned(const CameraPointing& p, const Turn& turn) {
  const auto& [yaw, pitch, roll] = turn;
  const double a = p.axis.ra * kPi / 180.0;
  const double d = p.axis.dec * kPi / 180.0;
  const double r = p.roll.value() * kPi / 180.0;
  const Direction n = to_direction(p.axis);
  const Direction e{-std::sin(a), std::cos(a), 0.0};
  const Direction t{-std::sin(d) * std::cos(a), -std::sin(d) * std::sin(a), std::cos(d)};
  const auto add = [](double f, Direction u, double g, Direction v) {
    return Direction{f * u.x + g * v.x, f * u.y + g * v.y, f * u.z + g * v.z};
  };
  const Direction x = add(-std::cos(r), e, -std::sin(r), t);
  const Direction y = add(-std::sin(r), e, std::cos(r), t);
  const double arcsec = kPi / 180.0 / 3600.0;
  // Stars move to +x when the axis moves to -x.
  Direction axis = n;
  Direction up = y;
  if (yaw != 0.0) axis = add(std::cos(yaw * arcsec), n, -std::sin(yaw * arcsec), x);
  if (pitch != 0.0) {
    axis = add(std::cos(pitch * arcsec), n, -std::sin(pitch * arcsec), y);
    up = add(std::cos(pitch * arcsec), y, std::sin(pitch * arcsec), n);
  }
  // Stars turn from +x to +y when the camera's y axis turns from y to x.
  if (roll != 0.0) up = add(std::cos(roll * arcsec), y, std::sin(roll * arcsec), x);
  CameraPointing q = p;
  q.axis = to_sky_position(axis);
  const double a1 = q.axis.ra * kPi / 180.0;
  const double d1 = q.axis.dec * kPi / 180.0;
  const double up_east = -std::sin(a1) * up.x + std::cos(a1) * up.y;
  const double up_north =
      -std::sin(d1) * std::cos(a1) * up.x - std::sin(d1) * std::sin(a1) * up.y + std::cos(d1) * up.z;
  q.roll = Degrees(std::atan2(-up_east, up_north) * 180.0 / kPi);
  return q;
}

TEST(SkyProjection, AgreesWithTheClosedFormOfEveryProjection) {
  for (const std::string_view code : supported_projections()) {
    for (const double roll : {0.0, 30.0, -117.0}) {
      const CameraPointing pointing = lops2(std::string(code), roll);
      const SkyProjection projection(pointing);
      for (int i = 0; i < 16; ++i) {
        for (int k = 0; k < 10; ++k) {
          const double ra = 23.7 * i;
          const double dec = -90.0 + 13.1 * k;
          if (angular_separation(pointing.axis, {ra, dec}).value() > 80.0) continue;
          const auto pixel = projection.to_pixel({ra, dec});
          ASSERT_TRUE(pixel) << code;
          const PixelPosition expected = closed_form(pointing, {ra, dec});
          EXPECT_NEAR(pixel->x, expected.x, 1e-7) << code << " " << roll << " " << ra << " " << dec;
          EXPECT_NEAR(pixel->y, expected.y, 1e-7) << code << " " << roll << " " << ra << " " << dec;
        }
      }
    }
  }
}

TEST(SkyProjection, IncreasesXToTheWestAndYToTheNorth) {
  const SkyProjection projection(lops2());
  const auto west = projection.to_pixel({95.2104, -47.8869});
  const auto north = projection.to_pixel({95.3104, -47.7869});
  EXPECT_GT(west->x, 2254.5);
  EXPECT_GT(north->y, 2254.5);
  EXPECT_NEAR(north->x, 2254.5, 1e-7);
  // Roll turns the field from +x to +y: north goes from +y to -x.
  EXPECT_LT(SkyProjection(lops2("TAN", 90.0)).to_pixel({95.3104, -47.7869})->x, 2254.5);
}

TEST(SkyProjection, ClosesTheRoundTrip) {
  for (const std::string_view code : supported_projections()) {
    const SkyProjection projection(lops2(std::string(code), 12.0));
    for (int i = 0; i < 12; ++i) {
      for (int k = 0; k < 9; ++k) {
        const double x = 409.7 * i;
        const double y = 523.3 * k;
        const auto back = projection.to_pixel(projection.to_sky({x, y}));
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, x, kPixelGrid);
        EXPECT_NEAR(back->y, y, kPixelGrid);
      }
    }
  }
}

TEST(SkyProjection, PlacesManyAsOneByOne) {
  const SkyProjection projection(lops2("TAN", 3.0));
  std::vector<SkyPosition> stars;
  stars.reserve(1000);
  for (int i = 0; i < 1000; ++i) stars.push_back({0.36 * i, -80.0 + 0.1 * i});
  const auto together = projection.to_pixels(stars);
  int seen = 0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto alone = projection.to_pixel(stars[i]);
    ASSERT_EQ(alone.has_value(), together[i].has_value());
    if (!alone) continue;
    ++seen;
    EXPECT_EQ(alone->x, together[i]->x);
    EXPECT_EQ(alone->y, together[i]->y);
  }
  EXPECT_GT(seen, 100);
  EXPECT_LT(seen, 1000);
}

TEST(SkyProjection, RoundsPositionsToItsGrid) {
  const PixelPosition p = *SkyProjection(lops2()).to_pixel({95.0, -48.0});
  EXPECT_EQ(p.x / kPixelGrid, std::floor(p.x / kPixelGrid));
  EXPECT_EQ(round_to_pixel_grid({1.0 + 0.6 * kPixelGrid, -0.5 * kPixelGrid}).x, 1.0 + kPixelGrid);
  EXPECT_EQ(round_to_pixel_grid({1.0, -0.5 * kPixelGrid}).y, 0.0);
}

TEST(SkyProjection, SurvivesItsOwnHeader) {
  for (const std::string_view code : supported_projections()) {
    for (const double dec : {-47.8869, 90.0, -90.0}) {
      CameraPointing pointing = lops2(std::string(code), 25.0);
      pointing.axis.dec = dec;
      const SkyProjection projection(pointing);
      const auto read = SkyProjection::from_header(header_of(projection), "own.fits");
      ASSERT_TRUE(read);
      EXPECT_EQ(read->code(), code);
      EXPECT_NEAR(read->pixel_scale().value(), 15.0, 1e-7);
      const SkyPosition star = projection.to_sky({100.0, 4000.0});
      const auto pixel = read->to_pixel(star);
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x, 100.0, 2e-7);
      EXPECT_NEAR(pixel->y, 4000.0, 2e-7);
      const auto a = projection.attitude_jacobian(star);
      const auto b = read->attitude_jacobian(star);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->dx_dyaw, b->dx_dyaw, 1e-9);
      EXPECT_NEAR(a->dy_dpitch, b->dy_dpitch, 1e-9);
      EXPECT_NEAR(a->dx_droll, b->dx_droll, 1e-9);
    }
  }
}

TEST(SkyProjection, ShiftsTheReferencePixelOfASubField) {
  const auto cards = SkyProjection(lops2()).fits_cards(100, -20);
  double x = 0.0;
  double y = 0.0;
  for (const FitsCard& card : cards) {
    if (card.key == "CRPIX1") x = std::get<double>(card.value);
    if (card.key == "CRPIX2") y = std::get<double>(card.value);
  }
  EXPECT_EQ(x, 2254.5 - 100.0 + 1.0);
  EXPECT_EQ(y, 2254.5 + 20.0 + 1.0);
}

TEST(SkyProjection, ReadsGalacticHeaders) {
  // The galactic centre, ICRS 266.40499 -28.93617 (definition of the system, to 1e-5 deg).
  const auto projection = SkyProjection::from_header(
      header_text({"CTYPE1  = 'GLON-CAR'", "CTYPE2  = 'GLAT-CAR'", "CRPIX1  = 1.0", "CRPIX2  = 1.0", "CRVAL1  = 0.0",
                   "CRVAL2  = 0.0", "CDELT1  = -0.1", "CDELT2  = 0.1", "END"}),
      "galactic.fits");
  ASSERT_TRUE(projection);
  EXPECT_NEAR(projection->to_sky({0.0, 0.0}).ra, 266.40499, 2e-5);
  EXPECT_NEAR(projection->to_sky({0.0, 0.0}).dec, -28.93617, 2e-5);
  const auto back = projection->to_pixel(projection->to_sky({10.0, 20.0}));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->x, 10.0, kPixelGrid);
  EXPECT_NEAR(back->y, 20.0, kPixelGrid);
}

TEST(SkyProjection, ReadsNothingWhereThereIsNoWcs) {
  EXPECT_FALSE(SkyProjection::from_header(header_text({"SIMPLE  = T", "NAXIS   = 2", "END"}), "plain.fits"));
  EXPECT_FALSE(SkyProjection::from_header("", "empty.fits"));
}

TEST(SkyProjection, IsNotHarmedByATextThatNeverEnds) {
  EXPECT_FALSE(SkyProjection::from_header(
      header_text(
          {"CTYPE1  = 'RA---TAN-SIP. and so on until the card is full and nothing closes the quotation", "END"}),
      "open.fits"));
}

TEST(SkyProjection, NamesTheFileOfAHeaderItCannotUse) {
  const auto read = [](const std::vector<std::string>& more) {
    std::vector<std::string> cards = {"CTYPE1  = 'RA---TAN'", "CTYPE2  = 'DEC--TAN'", "CRPIX1  = 1.0",
                                      "CRPIX2  = 1.0",        "CDELT1  = 0.1",        "CDELT2  = 0.1"};
    cards.insert(cards.end(), more.begin(), more.end());
    cards.emplace_back("END");
    return SkyProjection::from_header(header_text(cards), "old.fits");
  };
  EXPECT_TRUE(read({}));
  EXPECT_TRUE(read({"RADESYS = 'FK5'", "EQUINOX = 2000.0"}));
  EXPECT_THAT([&] { (void)read({"RADESYS = 'FK4'"}); },
              ThrowsMessage<InputError>(
                  HasSubstr("old.fits: the world coordinates of the header cannot be used: RADESYS FK4")));
  EXPECT_THAT([&] { (void)read({"EQUINOX = 1950.0"}); }, ThrowsMessage<InputError>(HasSubstr("old.fits")));
  EXPECT_THAT([&] { (void)read({"CDELT1  = 0.0"}); }, ThrowsMessage<InputError>(HasSubstr("old.fits")));
  EXPECT_THAT([&] { (void)read({"CTYPE2  = 'LINEAR'"}); }, ThrowsMessage<InputError>(HasSubstr("old.fits")));
}

TEST(SkyProjection, ReportsEveryProblemOfAPointing) {
  CameraPointing pointing = lops2("CAR");
  pointing.axis.dec = 91.0;
  pointing.scale = PixelScale(0.0);
  try {
    const SkyProjection projection(pointing);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
    EXPECT_THAT(error.what(), HasSubstr("projection = CAR: cannot be used; expected TAN, SIN, ARC, STG or ZEA"));
  }
}

TEST(SkyProjection, RefusesPositionsThatAreNone) {
  const SkyProjection projection(lops2("ZEA"));
  EXPECT_FALSE(projection.to_pixel({std::nan(""), 0.0}));
  EXPECT_FALSE(projection.to_pixel({0.0, 100.0}));
  EXPECT_FALSE(projection.to_pixel({275.3104, 47.8869}));  // antipode
  EXPECT_TRUE(std::isnan(SkyProjection(lops2("SIN")).to_sky({1e6, 0.0}).ra));
}

TEST(SkyProjection, MayBeSharedByThreads) {
  const SkyProjection projection(lops2());
  const PixelPosition expected = *projection.to_pixel({95.0, -48.0});
  std::vector<std::jthread> threads;
  std::vector<int> wrong(4);
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 500; ++i) {
        const auto pixel = projection.to_pixel({95.0, -48.0});
        if (!pixel || pixel->x != expected.x || pixel->y != expected.y) ++wrong[t];
        (void)projection.to_sky(expected);
      }
    });
  }
  threads.clear();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(AttitudeJacobian, IsTheInverseScaleAtTheAxis) {
  for (const std::string_view code : supported_projections()) {
    const CameraPointing pointing = lops2(std::string(code), 40.0);
    const auto j = SkyProjection(pointing).attitude_jacobian(pointing.axis);
    ASSERT_TRUE(j);
    EXPECT_NEAR(j->dx_dyaw, 1.0 / 15.0, kJacobianGrid);
    EXPECT_NEAR(j->dy_dpitch, 1.0 / 15.0, kJacobianGrid);
    EXPECT_EQ(j->dx_dpitch, 0.0);
    EXPECT_EQ(j->dy_dyaw, 0.0);
    EXPECT_EQ(j->dx_droll, 0.0);
    EXPECT_EQ(j->dy_droll, 0.0);
  }
}

TEST(AttitudeJacobian, OfRollTurnsTheFieldAboutTheAxis) {
  const SkyProjection projection(lops2("TAN", 10.0));
  const SkyPosition star = projection.to_sky({4254.5, 1254.5});
  const auto j = projection.attitude_jacobian(star);
  ASSERT_TRUE(j);
  const double arcsec = kPi / 180.0 / 3600.0;
  EXPECT_NEAR(j->dx_droll, 1000.0 * arcsec, 1e-9);
  EXPECT_NEAR(j->dy_droll, 2000.0 * arcsec, 1e-9);
}

// In TAN with x and y in units of the focal length: dx/dyaw = 1 + x^2, dx/dpitch = dy/dyaw = xy, dy/dpitch = 1 + y^2.
TEST(AttitudeJacobian, HasTheClosedFormOfTheGnomonicProjectionUpToTheEdge) {
  const CameraPointing pointing = lops2("TAN", -20.0);
  const SkyProjection projection(pointing);
  for (const double theta : {0.5, 5.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.9}) {
    const double focal = 180.0 / kPi * 3600.0 / 15.0;  // px
    const double radius = std::tan(theta * kPi / 180.0);
    const double x = 0.6 * radius;
    const double y = -0.8 * radius;
    const auto j = projection.attitude_jacobian(projection.to_sky({2254.5 + x * focal, 2254.5 + y * focal}));
    ASSERT_TRUE(j) << theta;
    const double largest = (1.0 + radius * radius) / 15.0;
    const double tolerance = 1e-8 * largest + kJacobianGrid;
    EXPECT_NEAR(j->dx_dyaw, (1.0 + x * x) / 15.0, tolerance) << theta;
    EXPECT_NEAR(j->dx_dpitch, x * y / 15.0, tolerance) << theta;
    EXPECT_NEAR(j->dy_dyaw, x * y / 15.0, tolerance) << theta;
    EXPECT_NEAR(j->dy_dpitch, (1.0 + y * y) / 15.0, tolerance) << theta;
  }
}

TEST(AttitudeJacobian, AgreesWithAPointingThatIsTurned) {
  for (const std::string_view code : supported_projections()) {
    const CameraPointing pointing = lops2(std::string(code), 33.0);
    const SkyProjection projection(pointing);
    const SkyPosition star = projection.to_sky({300.0, 4100.0});
    const auto j = projection.attitude_jacobian(star);
    ASSERT_TRUE(j);
    const double h = 60.0;  // arcsec; the second-order term of a central difference is below 1e-8 of the scale
    const auto slope = [&](const Turn& turn) {
      const Turn back{-turn.yaw, -turn.pitch, -turn.roll};
      const PixelPosition plus = closed_form(turned(pointing, turn), star);
      const PixelPosition minus = closed_form(turned(pointing, back), star);
      return PixelPosition{(plus.x - minus.x) / (2.0 * h), (plus.y - minus.y) / (2.0 * h)};
    };
    const PixelPosition yaw = slope({.yaw = h});
    const PixelPosition pitch = slope({.pitch = h});
    const PixelPosition roll = slope({.roll = h});
    const double tolerance = 5e-8 / 15.0;
    EXPECT_NEAR(j->dx_dyaw, yaw.x, tolerance) << code;
    EXPECT_NEAR(j->dy_dyaw, yaw.y, tolerance) << code;
    EXPECT_NEAR(j->dx_dpitch, pitch.x, tolerance) << code;
    EXPECT_NEAR(j->dy_dpitch, pitch.y, tolerance) << code;
    EXPECT_NEAR(j->dx_droll, roll.x, tolerance) << code;
    EXPECT_NEAR(j->dy_droll, roll.y, tolerance) << code;
  }
}

TEST(AttitudeJacobian, IsAbsentWhereThereIsNoImage) {
  EXPECT_FALSE(SkyProjection(lops2()).attitude_jacobian({275.3104, 47.8869}));
}

// With distortion.

CameraPointing distorted_plato(const std::string& code = "TAN") {
  CameraPointing pointing = lops2(code, 25.0);
  pointing.distortion = make_radial_distortion(test::plato_distortion(), test::plato_focal_length());
  pointing.detector = {0, 0, 4510, 4510};
  return pointing;
}

TEST(SkyProjection, WithDistortionReturnsWhereItCameFrom) {
  for (const std::string_view code : supported_projections()) {
    const SkyProjection projection(distorted_plato(std::string(code)));
    for (double y = 0.0; y < 4510.0; y += 400.3) {
      for (double x = 0.0; x < 4510.0; x += 400.7) {
        const auto pixel = projection.to_pixel(projection.to_sky({x, y}));
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x, x, kPixelGrid);
        EXPECT_NEAR(pixel->y, y, kPixelGrid);
      }
    }
    EXPECT_EQ(projection.to_pixel(projection.axis())->x, projection.axis_pixel().x);
  }
}

TEST(SkyProjection, WithDistortionHasTheJacobianOfItsPositions) {
  // A star moves as the position of a camera turned about its axis, or pointed elsewhere.
  const CameraPointing pointing = distorted_plato();
  const SkyProjection projection(pointing);
  const SkyPosition star = projection.to_sky({4300.0, 200.0});
  const auto jacobian = projection.attitude_jacobian(star);
  ASSERT_TRUE(jacobian);
  const auto moved = [&](double roll) {
    CameraPointing turned = pointing;
    turned.roll = Degrees(pointing.roll.value() + roll / 3600.0);
    return *SkyProjection(turned).to_pixel(star);
  };
  constexpr double kTurn = 20.0;  // arcsec
  EXPECT_NEAR(jacobian->dx_droll, (moved(kTurn).x - moved(-kTurn).x) / (2.0 * kTurn), 1e-8);
  EXPECT_NEAR(jacobian->dy_droll, (moved(kTurn).y - moved(-kTurn).y) / (2.0 * kTurn), 1e-8);
  // Distortion stretches what yaw does: at 13 deg by some per cent.
  CameraPointing perfect = pointing;
  perfect.distortion = nullptr;
  const auto straight = SkyProjection(perfect).attitude_jacobian(star);
  EXPECT_GT(std::abs(jacobian->dx_dyaw / straight->dx_dyaw - 1.0), 0.01);
}

TEST(SkyProjection, GivesTheAngleFromTheAxisOfAPixel) {
  for (const bool with_distortion : {false, true}) {
    for (const std::string_view code : supported_projections()) {
      CameraPointing pointing = distorted_plato(std::string(code));
      if (!with_distortion) pointing.distortion = nullptr;
      const SkyProjection projection(pointing);
      for (const PixelPosition p : {PixelPosition{0.0, 0.0}, {4509.0, 17.5}, {2254.5, 2254.5}, {2254.6, 2254.5}}) {
        EXPECT_NEAR(projection.field_angle(p)->value(),
                    angular_separation(projection.axis(), projection.to_sky(p)).value(), 2e-12);
      }
    }
  }
  EXPECT_FALSE(SkyProjection(lops2("SIN")).field_angle({1e6, 0.0}));
}

TEST(SkyProjection, HasNoImageBeyondAFold) {
  CameraPointing pointing = lops2();
  pointing.distortion = make_radial_distortion({.k1 = -10.0}, test::plato_focal_length());  // folds at tan = 0.1826
  pointing.detector = {2000, 2000, 500, 500};
  const SkyProjection projection(pointing);
  EXPECT_TRUE(projection.to_pixel({95.3104, -47.8869 + 10.0}));
  EXPECT_FALSE(projection.to_pixel({95.3104, -47.8869 + 11.0}));
  EXPECT_FALSE(projection.to_pixel({95.3104, -47.8869 + 60.0}));
  EXPECT_FALSE(projection.attitude_jacobian({95.3104, -47.8869 + 30.0}));
  EXPECT_TRUE(std::isnan(projection.to_sky({2254.5, 20000.0}).ra));
  EXPECT_FALSE(projection.field_angle({2254.5, 20000.0}));
}

TEST(SkyProjection, WritesNoCoordinatesWhereNoSipPolynomialIsGoodEnough) {
  CameraPointing pointing = lops2();
  pointing.distortion = make_radial_distortion({.k1 = -10.0}, test::plato_focal_length());
  pointing.detector = {0, 0, 4510, 4510};  // its corner is beyond the fold
  EXPECT_TRUE(SkyProjection(pointing).fits_cards().empty());
  pointing.detector = {};
  EXPECT_THROW(static_cast<void>(SkyProjection(pointing)), InputError);
}

TEST(SkyProjection, ReadsItsOwnDistortedHeader) {
  SipPolynomial sip(3);
  sip.a[sip.index(2, 0)] = 3e-6;
  sip.a[sip.index(1, 2)] = -2e-9;
  sip.b[sip.index(1, 1)] = 4e-6;
  CameraPointing pointing = lops2("TAN", 12.0);
  pointing.distortion = make_sip_distortion(sip);
  pointing.detector = {0, 0, 4510, 4510};
  const SkyProjection projection(pointing);
  const auto read = SkyProjection::from_header(header_of(projection), "self.fits");
  ASSERT_TRUE(read);
  for (const PixelPosition p : {PixelPosition{0.0, 0.0}, {4509.0, 17.5}, {100.0, 4400.0}})
    EXPECT_LT(to_arcseconds(angular_separation(read->to_sky(p), projection.to_sky(p))).value(), 1e-6);
}

}  // namespace
}  // namespace astroid
