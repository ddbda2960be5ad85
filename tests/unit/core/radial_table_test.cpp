#include "radial_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace astroid::detail {
namespace {

TEST(RadialTable, IsTheFunction) {
  // A Lorentzian has its poles at the length over which it changes; a wave turns once in six of its own.
  const auto lorentzian = [](double r) { return 1.0 / (1.0 + r * r); };
  const auto wave = [](double r) { return std::cos(r); };
  const RadialTable rational(lorentzian, 20.0, 0.25);
  const RadialTable periodic(wave, 20.0, 0.25);
  for (int i = 0; i < 4000; ++i) {
    const double r = 0.005 * (i + 0.37);
    EXPECT_NEAR(rational.at(r * r), lorentzian(r), 1e-13 * lorentzian(r)) << r;
    EXPECT_NEAR(periodic.at(r * r), wave(r), 1e-13) << r;
  }
}

TEST(RadialTable, IsZeroBeyondItsEnd) {
  const RadialTable table([](double) { return 1.0; }, 3.0, 0.4);
  EXPECT_NEAR(table.at(0.0), 1.0, 1e-14);
  EXPECT_NEAR(table.at(8.999), 1.0, 1e-14);
  EXPECT_EQ(table.at(9.0), 0.0);
  EXPECT_EQ(table.at(1e300), 0.0);
  EXPECT_EQ(table.at(std::nan("")), 0.0);
}

}  // namespace
}  // namespace astroid::detail
