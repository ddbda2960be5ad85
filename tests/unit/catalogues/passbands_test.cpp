#include "astroid/catalogues/passbands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

StarCatalogue catalogue_of(const std::string& passband, const std::string& colour_index, double magnitude,
                           double colour, double teff = kUnknown) {
  StarCatalogue catalogue;
  catalogue.source = "stars.csv";
  catalogue.passband = passband;
  catalogue.colour_index = colour_index;
  catalogue.stars.push_back({.id = "A",
                             .sky = {},
                             .pixel = {},
                             .magnitude = Magnitude(magnitude),
                             .electrons = 0,
                             .colour = colour,
                             .teff = teff});
  return catalogue;
}

double converted(StarCatalogue catalogue, const std::string& to, const PassbandAssumptions& assumptions = {}) {
  convert_passband(catalogue, to, assumptions);
  EXPECT_EQ(catalogue.passband, to);
  return catalogue.stars.front().magnitude.value();
}

TEST(CanonicalPassband, KnowsTheUsualSpellings) {
  EXPECT_EQ(canonical_passband("VT"), "V_T");
  EXPECT_EQ(canonical_passband("V_T"), "V_T");
  EXPECT_EQ(canonical_passband("vtmag"), "V_T");
  EXPECT_EQ(canonical_passband("Gaia G"), "G");
  EXPECT_EQ(canonical_passband("TESS"), "T");
  EXPECT_EQ(canonical_passband("kp"), "Kp");
  EXPECT_EQ(canonical_passband("v"), "V");
}

TEST(CanonicalPassband, LeavesOtherNamesAlone) {
  EXPECT_EQ(canonical_passband("g"), "g");
  EXPECT_EQ(canonical_passband("J"), "J");
}

TEST(ConvertPassband, TurnsVIntoPOfTheSun) {
  // -0.2283938 + 1.5110180 - 3.3541290 + 2.449 by hand
  EXPECT_NEAR(converted(catalogue_of("V", "", 10.0, kUnknown, 5778.0), "P"), 10.0 - 0.3774952, 1e-7);
}

TEST(ConvertPassband, TurnsGIntoVOfTheSun) {
  EXPECT_NEAR(converted(catalogue_of("G", "BP-RP", 10.0, 0.82), "V"), 10.0 + 0.1525, 5e-5);
}

TEST(ConvertPassband, TurnsTychoIntoJohnsonByTheColour) {
  EXPECT_NEAR(converted(catalogue_of("V_T", "B_T-V_T", 10.0, 0.7), "V"), 10.0 - 0.063, 1e-12);
  EXPECT_NEAR(converted(catalogue_of("V_T", "B-V", 10.0, 0.595), "V"), 10.0 - 0.063, 1e-12);
  EXPECT_NEAR(converted(catalogue_of("B_T", "B_T-V_T", 10.7, 0.7), "V"), 10.0 - 0.063, 1e-12);
}

TEST(ConvertPassband, ChainsRelations) {
  const double v = converted(catalogue_of("V_T", "B_T-V_T", 10.0, 0.7, 5778.0), "V");
  EXPECT_NEAR(converted(catalogue_of("V_T", "B_T-V_T", 10.0, 0.7, 5778.0), "P"), v - v_minus_p(5778.0).value(), 1e-12);
  const double from_g = converted(catalogue_of("G", "BP-RP", 10.0, 0.82, 5778.0), "P");
  EXPECT_NEAR(from_g, 10.0 + 0.1525 - 0.3775, 1e-4);
}

TEST(ConvertPassband, ThereAndBackIsTheSameMagnitude) {
  for (const double colour : {-0.1, 0.3, 0.82, 1.4, 2.5}) {
    StarCatalogue catalogue = catalogue_of("G", "BP-RP", 12.5, colour);
    convert_passband(catalogue, "P", {});
    convert_passband(catalogue, "G", {});
    EXPECT_NEAR(catalogue.stars.front().magnitude.value(), 12.5, 1e-12) << colour;
  }
}

TEST(ConvertPassband, AssumesTheStatedColourAndCountsIt) {
  StarCatalogue catalogue = catalogue_of("V_T", "", 10.0, kUnknown);
  convert_passband(catalogue, "P", {.bv = 0.85, .teff = 5000.0});
  EXPECT_NEAR(catalogue.stars.front().magnitude.value(), 10.0 - 0.09 - v_minus_p(5000.0).value(), 1e-12);
  EXPECT_THAT(catalogue.notes, Contains(HasSubstr("1 of 1 stars have no colour: B-V = 0.85 assumed")));
  EXPECT_THAT(catalogue.notes, Contains(HasSubstr("5000 K assumed")));
}

TEST(ConvertPassband, PrefersTheStarsOwnTemperatureAndColour) {
  StarCatalogue catalogue = catalogue_of("V", "B-V", 10.0, 0.65);
  convert_passband(catalogue, "P", {.bv = 0.0, .teff = 10000.0});
  EXPECT_NEAR(catalogue.stars.front().magnitude.value(), 10.0 - v_minus_p(teff_from_bv(0.65)).value(), 1e-12);
  EXPECT_THAT(catalogue.notes, testing::Not(Contains(HasSubstr("assumed"))));
}

TEST(ConvertPassband, CountsStarsOutsideARelationsRange) {
  StarCatalogue catalogue = catalogue_of("V", "", 10.0, kUnknown, 40000.0);
  convert_passband(catalogue, "P", {});
  EXPECT_NEAR(catalogue.stars.front().magnitude.value(), 10.0 - v_minus_p(15000.0).value(), 1e-12);
  EXPECT_THAT(catalogue.notes, Contains(HasSubstr("1 of 1 stars have a colour or temperature outside")));
}

TEST(ConvertPassband, RefusesPassbandsWithoutARelation) {
  StarCatalogue catalogue = catalogue_of("T", "", 10.0, kUnknown);
  try {
    convert_passband(catalogue, "P", {});
    FAIL() << "converted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("passband mismatch: catalogue is in T, zero point in P; there is no conversion"));
  }
  EXPECT_EQ(catalogue.stars.front().magnitude.value(), 10.0);
}

TEST(ConvertPassband, LeavesTheSamePassbandAndElectronsAlone) {
  EXPECT_EQ(converted(catalogue_of("J", "", 10.0, kUnknown), "J"), 10.0);
  StarCatalogue electrons = catalogue_of("", "", 0.0, kUnknown);
  electrons.brightness = BrightnessKind::kElectrons;
  convert_passband(electrons, "P", {});
  EXPECT_EQ(electrons.stars.front().magnitude.value(), 0.0);
  EXPECT_TRUE(electrons.notes.empty());
}

}  // namespace
}  // namespace astroid
