// The light of columns is the marginal of the PSF, less what falls beside the detector.
#include "astroid/core/column_light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace astroid {
namespace {

constexpr double kSigma = 0.6;
constexpr double kReach = 8.0;  // sigma: what lies farther out is below 1e-14

StarLight star_at(double x, double y, double electrons) {
  return {.centre = {x, y}, .electrons = electrons, .half_width = kReach * kSigma};
}

// Share of a Gaussian between two edges.
double between(double from, double to) {
  return 0.5 * (std::erf(to / (kSigma * std::sqrt(2.0))) - std::erf(from / (kSigma * std::sqrt(2.0))));
}

TEST(ColumnLight, IsTheMarginalOfTheStamp) {
  const auto psf = make_gaussian_psf(kSigma);
  const Rectangle detector{0, 0, 40, 60};
  std::vector<double> columns(20, 0.0);
  std::vector<double> scratch;
  add_column_light(*psf, star_at(17.3, 31.8, 1e6), detector, 10, columns, scratch);
  for (int x = 10; x < 30; ++x)
    EXPECT_NEAR(columns[static_cast<std::size_t>(x - 10)], 1e6 * between(x - 17.8, x - 16.8), 1e-6) << x;
  EXPECT_NEAR(std::accumulate(columns.begin(), columns.end(), 0.0), 1e6, 1e-6);
}

TEST(ColumnLight, AWindowOfColumnsHasTheValuesOfAll) {
  const auto psf = make_gaussian_psf(kSigma);
  const Rectangle detector{0, 0, 40, 60};
  std::vector<double> all(40, 0.0);
  std::vector<double> few(3, 0.0);
  std::vector<double> scratch;
  for (const double x : {16.2, 17.9, 25.4}) {
    add_column_light(*psf, star_at(x, 5.0 + x, 1e5), detector, 0, all, scratch);
    add_column_light(*psf, star_at(x, 5.0 + x, 1e5), detector, 17, few, scratch);
  }
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i], all[17 + i]) << i;
}

TEST(ColumnLight, LosesWhatFallsBesideTheDetector) {
  const auto psf = make_gaussian_psf(kSigma);
  const Rectangle detector{0, 0, 20, 30};
  std::vector<double> columns(20, 0.0);
  std::vector<double> scratch;
  add_column_light(*psf, star_at(10.0, -0.5, 1e6), detector, 0, columns, scratch);  // on the edge of the first row
  EXPECT_NEAR(std::accumulate(columns.begin(), columns.end(), 0.0), 5e5, 1e-3);
  std::vector<double> beside(20, 0.0);
  add_column_light(*psf, star_at(10.0, 45.0, 1e6), detector, 0, beside, scratch);
  add_column_light(*psf, star_at(std::nan(""), 5.0, 1e6), detector, 0, beside, scratch);
  EXPECT_EQ(std::accumulate(beside.begin(), beside.end(), 0.0), 0.0);
}

TEST(ColumnLight, ChangesAsItsGradientSays) {
  const auto psf = make_gaussian_psf(kSigma);
  const Rectangle detector{0, 0, 20, 30};
  std::vector<double> scratch;
  constexpr double kStep = 1e-4;  // px: central differences are good to the square of it
  for (const double y : {15.2, 0.3}) {
    std::vector<double> along_x(20, 0.0);
    std::vector<double> along_y(20, 0.0);
    add_column_gradient(*psf, star_at(9.7, y, 1e6), detector, 0, along_x, along_y, scratch);
    for (const bool is_x : {true, false}) {
      std::vector<double> after(20, 0.0);
      std::vector<double> before(20, 0.0);
      const double dx = is_x ? kStep : 0.0;
      const double dy = is_x ? 0.0 : kStep;
      add_column_light(*psf, star_at(9.7 + dx, y + dy, 1e6), detector, 0, after, scratch);
      add_column_light(*psf, star_at(9.7 - dx, y - dy, 1e6), detector, 0, before, scratch);
      for (std::size_t i = 0; i < 20; ++i)
        EXPECT_NEAR((is_x ? along_x : along_y)[i], (after[i] - before[i]) / (2.0 * kStep), 1e-7 * 1e6)
            << (is_x ? "x " : "y ") << i << " at row " << y;
    }
  }
}

TEST(ColumnLight, ClockingShareOfPlatoIsThatOfTheBudget) {
  // 4.019 s for 4510 rows, 21 s: a star leaves 4.24e-5 of its column's light in every row.
  EXPECT_NEAR(clocking_share(4.019, 21.0, 4510), 4.2434e-5, 1e-9);
  EXPECT_EQ(clocking_share(4.019, 21.0, 0), 0.0);
  EXPECT_EQ(clocking_share(4.019, 0.0, 4510), 0.0);
}

}  // namespace
}  // namespace astroid
