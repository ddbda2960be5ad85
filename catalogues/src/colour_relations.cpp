#include <cmath>

#include "astroid/catalogues/passbands.hpp"

namespace astroid {

namespace {

// ESA 1997, The Hipparcos and Tycho Catalogues, vol. 1, Eq. 1.3.20.
constexpr double kVtToVSlope = -0.090;
constexpr double kBtVtToBvSlope = 0.850;

// Ballesteros 2012 (EPL 97, 34008), Eq. 14: T = 4600 K (1 / (0.92 BV + 1.7) + 1 / (0.92 BV + 0.62)).
constexpr double kBallesterosTemperature = 4600.0;  // K
constexpr double kBallesterosSlope = 0.92;          // 1/mag
constexpr double kBallesterosV = 1.7;
constexpr double kBallesterosB = 0.62;

// Mucciarelli, Bellazzini & Massari 2021 (A&A 653, A90), Table 1, dwarfs at [Fe/H] = 0: 5040 K / Teff = b0 + b1 C + b2
// C^2.
constexpr double kThetaTemperature = 5040.0;  // K
constexpr double kTheta0 = 0.4929;
constexpr double kTheta1 = 0.5092;   // 1/mag
constexpr double kTheta2 = -0.0353;  // 1/mag^2

double cubic(double x, double c0, double c1, double c2, double c3) {
  return c0 + x * (c1 + x * (c2 + x * c3));
}

}  // namespace

DeltaMag v_minus_vt(double bt_vt) {
  return DeltaMag(kVtToVSlope * bt_vt);
}

double bv_from_bt_vt(double bt_vt) {
  return kBtVtToBvSlope * bt_vt;
}

// Gaia EDR3 documentation, table 5.9.
DeltaMag g_minus_v(double bp_rp) {
  return DeltaMag(cubic(bp_rp, -0.02704, 0.01424, -0.2156, 0.01426));
}

// Marchiori et al. 2019 (A&A 627, A71), Eq. 8.
DeltaMag v_minus_p(double teff) {
  return DeltaMag(cubic(teff, 2.449, -5.805e-4, 4.526e-8, -1.184e-12));
}

double teff_from_bv(double bv) {
  const double a = kBallesterosSlope * bv;
  return kBallesterosTemperature * (1.0 / (a + kBallesterosV) + 1.0 / (a + kBallesterosB));
}

double bv_from_teff(double teff) {
  // With a = 0.92 BV and t = T / 4600 K: t a^2 + (t (1.7 + 0.62) - 2) a + 1.7 * 0.62 t - (1.7 + 0.62) = 0.
  const double t = teff / kBallesterosTemperature;
  const double sum = kBallesterosV + kBallesterosB;
  const double b = t * sum - 2.0;
  const double c = t * kBallesterosV * kBallesterosB - sum;
  return (-b + std::sqrt(b * b - 4.0 * t * c)) / (2.0 * t) / kBallesterosSlope;
}

double teff_from_bp_rp(double bp_rp) {
  return kThetaTemperature / (kTheta0 + bp_rp * (kTheta1 + bp_rp * kTheta2));
}

double bp_rp_from_teff(double teff) {
  const double c = kTheta0 - kThetaTemperature / teff;
  return (-kTheta1 + std::sqrt(kTheta1 * kTheta1 - 4.0 * kTheta2 * c)) / (2.0 * kTheta2);
}

}  // namespace astroid
