#include "astroid/sim/attitude_polynomial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace astroid {
namespace {

constexpr std::array<double, 7> kDerivatives{1.0, 1.0, 3.0, 10.0, 40.0, 150.0, 600.0};  // px^-n

TEST(AttitudeTerms, AreFewerForLessAccuracy) {
  std::size_t last = 100;
  for (const double allowed : {1e-9, 1e-7, 1e-5, 1e-3}) {
    double left_out = 0.0;
    const auto terms = choose_attitude_terms(kDerivatives, {0.011, 0.011, 1e-4}, allowed, 60, left_out);
    ASSERT_FALSE(terms.empty());
    EXPECT_LE(left_out, allowed);
    EXPECT_LT(terms.size(), last);
    last = terms.size();
  }
}

TEST(AttitudeTerms, HoldEveryLowerPowerOfEachTerm) {
  double left_out = 0.0;
  const auto terms = choose_attitude_terms(kDerivatives, {0.011, 0.02, 1e-4}, 1e-8, 60, left_out);
  EXPECT_EQ(terms.front(), (AttitudePowers{0, 0, 0}));
  for (const AttitudePowers& powers : terms)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      AttitudePowers lower = powers;
      if (--lower[axis] < 0) continue;
      EXPECT_NE(std::ranges::find(terms, lower), terms.end());
    }
}

TEST(AttitudeTerms, LeaveOutAnAxisThatDoesNotMove) {
  double left_out = 0.0;
  for (const AttitudePowers& powers : choose_attitude_terms(kDerivatives, {0.011, 0.0, 0.0}, 1e-8, 60, left_out)) {
    EXPECT_EQ(powers[1], 0);
    EXPECT_EQ(powers[2], 0);
  }
}

TEST(AttitudeTerms, AreNoneWhereTooManyAreNeeded) {
  double left_out = 0.0;
  EXPECT_TRUE(choose_attitude_terms(kDerivatives, {0.5, 0.5, 0.5}, 1e-8, 24, left_out).empty());
  EXPECT_EQ(choose_attitude_terms(kDerivatives, {0.0, 0.0, 0.0}, 1e-8, 24, left_out).size(), 1U);
}

/// A polynomial with exactly these terms.
double polynomial_value(const AttitudePolynomial& p, const Attitude& a) {
  double sum = 0.0;
  for (std::size_t t = 0; t < p.terms.size(); ++t)
    sum += (1.0 + 0.3 * static_cast<double>(t)) * std::pow(a.yaw, p.terms[t][0]) * std::pow(a.pitch, p.terms[t][1]) *
           std::pow(a.roll, p.terms[t][2]);
  return sum;
}

TEST(AttitudePolynomial, GivesBackWhatIsAPolynomialOfItsTerms) {
  AttitudePolynomial p;
  double left_out = 0.0;
  p.terms = choose_attitude_terms(kDerivatives, {0.02, 0.011, 3e-3}, 1e-9, 60, left_out);
  p.scale = {0.17, 0.2, 0.3};
  ASSERT_GT(p.terms.size(), 12U);
  const Attitude centre = cell_centre(p, {0.5, -0.3, 0.0});
  EXPECT_NEAR(centre.yaw, 0.34, 1e-12);  // cells are 0.34 wide, the first reaches to 0.17
  EXPECT_NEAR(centre.pitch, -0.4, 1e-12);
  EXPECT_EQ(centre.roll, 0.0);
  const std::vector<MotionPoint> points = interpolation_points(p, centre);
  const std::vector<double> inverse = coefficients_from_values(p);
  const std::size_t n = points.size();
  for (const Attitude& where : {Attitude{0.5, -0.3, 0.1}, Attitude{0.18, -0.6, -0.29}, Attitude{0.34, -0.4, 0.0}}) {
    const std::vector<double> terms = mean_of_terms(p, centre, std::array{where});
    double value = 0.0;
    for (std::size_t t = 0; t < n; ++t)
      for (std::size_t k = 0; k < n; ++k)
        value += terms[t] * inverse[t * n + k] * polynomial_value(p, points[k].attitude);
    EXPECT_NEAR(value, polynomial_value(p, where), 1e-11);
  }
}

TEST(AttitudePolynomial, AveragesItsTermsOverAnExposure) {
  AttitudePolynomial p;
  p.terms = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  p.scale = {2.0, 0.0, 0.0};
  const std::array<Attitude, 2> steps{Attitude{1.0, 5.0, 7.0}, Attitude{-1.0, 5.0, 7.0}};
  EXPECT_EQ(mean_of_terms(p, {}, steps), (std::vector<double>{1.0, 0.0, 0.25}));
}

// Light e^u of a star at u = px (e^(rate t) - 1): all of its derivatives are as large as they may be.
TEST(AttitudePolynomial, BoundsWhatPowersOfTimeAreMissing) {
  const std::vector<double> ones(7, 1.0);
  constexpr SlowMotion kSlow{.px = 0.6, .rate = 0.15};
  for (const double allowed : {1e-3, 1e-5}) {
    double left_out = 0.0;
    AttitudePolynomial p;
    p.terms = choose_attitude_terms(ones, {.slow = kSlow}, allowed, 24, left_out);
    ASSERT_FALSE(p.terms.empty());
    EXPECT_LE(left_out, allowed);
    EXPECT_EQ(p.highest_power_of_time(), static_cast<int>(p.terms.size()) - 1);
    const std::vector<MotionPoint> points = interpolation_points(p, {});
    const std::vector<double> inverse = coefficients_from_values(p);
    const auto light = [&](double t) { return std::exp(kSlow.px * std::expm1(kSlow.rate * t)); };
    double worst = 0.0;
    for (double t = -1.0; t <= 1.0; t += 0.01) {
      const std::vector<double> terms = mean_of_terms(p, {}, std::array{Attitude{}}, t);
      double value = 0.0;
      for (std::size_t i = 0; i < terms.size(); ++i)
        for (std::size_t k = 0; k < terms.size(); ++k)
          value += terms[i] * inverse[i * terms.size() + k] * light(points[k].time);
      worst = std::max(worst, std::abs(value - light(t)));
    }
    EXPECT_LT(worst, left_out);
    EXPECT_GT(worst, 1e-3 * left_out);  // and no better by far
  }
}

TEST(AttitudePolynomial, NeedsNoTimeWhereNothingMovesByItself) {
  double left_out = 0.0;
  AttitudePolynomial p;
  p.terms = choose_attitude_terms(kDerivatives, {0.02, 0.011, 3e-3, {.px = 0.0, .rate = 1.0}}, 1e-9, 60, left_out);
  EXPECT_EQ(p.highest_power_of_time(), 0);
}

}  // namespace
}  // namespace astroid
