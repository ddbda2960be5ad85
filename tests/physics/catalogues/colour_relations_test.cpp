#include <gtest/gtest.h>

#include "astroid/catalogues/passbands.hpp"

namespace astroid {
namespace {

TEST(ColourRelations, HaveThePublishedValues) {
  EXPECT_NEAR(v_minus_p(5778.0).value(), 0.3774952, 1e-7);  // Marchiori et al. 2019, Eq. 8, by hand
  EXPECT_NEAR(g_minus_v(0.82).value(), -0.1525, 5e-5);      // Gaia EDR3 documentation, the Sun's BP-RP
  EXPECT_NEAR(g_minus_v(1.0).value(), -0.21414, 1e-12);     // sum of the four coefficients
  EXPECT_NEAR(v_minus_vt(1.0).value(), -0.090, 1e-15);      // ESA 1997
  EXPECT_NEAR(bv_from_bt_vt(0.7), 0.595, 1e-12);
  EXPECT_NEAR(teff_from_bv(0.65), 5778.3, 0.5);              // Ballesteros 2012: the Sun
  EXPECT_NEAR(teff_from_bp_rp(1.0), 5040.0 / 0.9668, 1e-9);  // Mucciarelli et al. 2021: sum of the coefficients
}

TEST(ColourRelations, AgreeOnTheSunWithinTheirScatter) {
  constexpr double kSun = 5772.0;  // K, IAU 2015 B3
  EXPECT_NEAR(teff_from_bp_rp(0.82), kSun, 2 * 61.0);
  EXPECT_NEAR(teff_from_bv(0.653), kSun, 50.0);  // B-V of the Sun: Ramirez et al. 2012
}

TEST(ColourRelations, InvertExactly) {
  for (int step = 0; step <= 46; ++step) {
    const double colour = -0.3 + 0.05 * step;
    EXPECT_NEAR(bv_from_teff(teff_from_bv(colour)), colour, 1e-12);
    EXPECT_NEAR(bp_rp_from_teff(teff_from_bp_rp(colour)), colour, 1e-12);
  }
}

TEST(ColourRelations, RedderIsCooler) {
  for (int step = 0; step < 330; ++step) {
    const double colour = -0.3 + 0.01 * step;
    EXPECT_GT(teff_from_bp_rp(colour), teff_from_bp_rp(colour + 0.01)) << colour;
    EXPECT_GT(teff_from_bv(colour), teff_from_bv(colour + 0.01)) << colour;
  }
}

TEST(ColourRelations, CoolerIsBrighterInPThanInV) {
  for (int step = 0; step < 240; ++step) {
    const double teff = 3000.0 + 50.0 * step;
    EXPECT_GT(v_minus_p(teff).value(), v_minus_p(teff + 50.0).value()) << teff;
  }
}

// One dwarf, three catalogues: the ways to P differ by no more than the relations' scatters.
TEST(ColourRelations, LeadToTheSamePByWayOfTychoAndGaia) {
  for (const double teff : {4500.0, 5200.0, 5778.0, 6500.0}) {
    const double v = 10.0;
    const double bt_vt = bv_from_teff(teff) / 0.850;
    StarCatalogue tycho;
    tycho.passband = "V_T";
    tycho.colour_index = "B_T-V_T";
    tycho.stars.push_back({.id = "A",
                           .sky = {},
                           .pixel = {},
                           .magnitude = Magnitude(v - v_minus_vt(bt_vt).value()),
                           .electrons = 0,
                           .colour = bt_vt,
                           .teff = teff});
    StarCatalogue gaia;
    gaia.passband = "G";
    gaia.colour_index = "BP-RP";
    const double bp_rp = bp_rp_from_teff(teff);
    gaia.stars.push_back({.id = "A",
                          .sky = {},
                          .pixel = {},
                          .magnitude = Magnitude(v + g_minus_v(bp_rp).value()),
                          .electrons = 0,
                          .colour = bp_rp,
                          .teff = teff});
    convert_passband(tycho, "P", {});
    convert_passband(gaia, "P", {});
    EXPECT_NEAR(tycho.stars.front().magnitude.value(), v - v_minus_p(teff).value(), 1e-9) << teff;
    EXPECT_NEAR(gaia.stars.front().magnitude.value(), v - v_minus_p(teff).value(), 1e-9) << teff;
  }
}

}  // namespace
}  // namespace astroid
