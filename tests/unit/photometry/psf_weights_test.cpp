// The weights of a star among doubted light: what holds whatever the numbers.
#include "psf_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace astroid::detail {
namespace {

const std::vector<double> kStar{0.1, 0.5, 0.3, 0.05, 0.0};
const std::vector<double> kVariance{20.0, 60.0, 40.0, 15.0, 10.0};

struct Solution {
  std::vector<double> weights;
  PsfErrors errors;
};

Solution solve(const std::vector<double>& star, const std::vector<double>& variance,
               const std::vector<double>& doubts) {
  Solution solution{std::vector<double>(star.size()), {}};
  PsfScratch scratch;
  solution.errors = psf_weights({star, variance, doubts}, solution.weights, scratch);
  return solution;
}

double sum(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

TEST(PsfWeights, AreThoseOfTheWeightedMaskWithoutDoubts) {
  const Solution solution = solve(kStar, kVariance, {});
  double information = 0.0;
  for (std::size_t i = 0; i < kStar.size(); ++i) information += kStar[i] * kStar[i] / kVariance[i];
  for (std::size_t i = 0; i < kStar.size(); ++i)
    EXPECT_NEAR(solution.weights[i], kStar[i] / kVariance[i] / information, 1e-15);
  EXPECT_DOUBLE_EQ(solution.errors.noise, 1.0 / std::sqrt(information));
  EXPECT_DOUBLE_EQ(solution.errors.known, solution.errors.noise);
  EXPECT_EQ(solution.errors.doubt, 0.0);
}

TEST(PsfWeights, SeeNothingOfAnUnlimitedDoubt) {
  std::vector<double> doubt{0.0, 0.1, 0.5, 0.3, 0.1};
  for (double& light : doubt) light *= 1e6;
  const Solution solution = solve(kStar, kVariance, doubt);
  EXPECT_NEAR(sum(solution.weights, kStar), 1.0, 1e-14);
  EXPECT_NEAR(sum(solution.weights, doubt) / 1e6, 0.0, 1e-9);
  EXPECT_LT(*std::min_element(solution.weights.begin(), solution.weights.end()), 0.0);
  EXPECT_GT(solution.errors.noise, solution.errors.known);
}

TEST(PsfWeights, StateTheErrorsOfThemselves) {
  const std::vector<double> doubts{0.0, 1.0, 5.0, 3.0, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0};
  const Solution solution = solve(kStar, kVariance, doubts);
  double noise = 0.0;
  for (std::size_t i = 0; i < kStar.size(); ++i) noise += solution.weights[i] * solution.weights[i] * kVariance[i];
  EXPECT_NEAR(solution.errors.noise, std::sqrt(noise), 1e-13);
  double doubt = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    double left = 0.0;
    for (std::size_t i = 0; i < kStar.size(); ++i) left += solution.weights[i] * doubts[k * kStar.size() + i];
    doubt += left * left;
  }
  EXPECT_NEAR(solution.errors.doubt, std::sqrt(doubt), 1e-13);
}

TEST(PsfWeights, AreFiniteHoweverManyStarsCoincide) {
  // Forty neighbours in the same place as the star: what cannot be told apart is as wrong as they are doubted together.
  for (const double amount : {1e-3, 1.0, 1e3, 1e5, 1e9}) {
    std::vector<double> doubts;
    for (int k = 0; k < 40; ++k)
      for (const double fraction : kStar) doubts.push_back(amount * fraction);
    const Solution solution = solve(kStar, kVariance, doubts);
    if (std::isinf(solution.errors.doubt)) {
      EXPECT_GT(amount, 1e6) << "beyond the reach of double precision the star is given up, not made up";
      EXPECT_EQ(sum(solution.weights, solution.weights), 0.0);
      continue;
    }
    // Rounding grows with the square of the inflation: 3e9 for an amount of 1e5.
    EXPECT_NEAR(sum(solution.weights, kStar), 1.0, 1e-5) << amount;
    if (amount >= 1.0) {
      EXPECT_NEAR(solution.errors.doubt / (amount * std::sqrt(40.0)), 1.0, 1e-5) << amount;
    }
  }
}

TEST(PsfWeights, GiveUpWithoutLight) {
  for (const std::vector<double>& star : {std::vector<double>{}, std::vector<double>(5, 0.0)}) {
    const Solution solution = solve(star, std::vector<double>(star.size(), 10.0), {});
    EXPECT_TRUE(std::isinf(solution.errors.noise));
    for (const double weight : solution.weights) EXPECT_EQ(weight, 0.0);
  }
}

TEST(PsfWeights, GiveNoWeightToAPixelWithoutVariance) {
  const Solution solution = solve({0.6, 0.4, 0.0}, {6.0, 4.0, 0.0}, {1.0, 2.0, 0.0});
  EXPECT_EQ(solution.weights[2], 0.0);
  EXPECT_NEAR(0.6 * solution.weights[0] + 0.4 * solution.weights[1], 1.0, 1e-15);
}

}  // namespace
}  // namespace astroid::detail
