#include "astroid/core/units.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace astroid {
namespace {

template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Multipliable = requires(A a, B b) {
  a* b;
};

TEST(Units, GainTurnsElectronsIntoAduAndBack) {
  const Gain gain(25.0);
  EXPECT_DOUBLE_EQ((Electrons(100.0) / gain).value(), 4.0);
  EXPECT_DOUBLE_EQ((Adu(4.0) * gain).value(), 100.0);
}

TEST(Units, RateTimesTimeIsACount) {
  EXPECT_DOUBLE_EQ((ElectronsPerSecond(45.0) * Seconds(21.0)).value(), 945.0);
}

TEST(Units, MagnitudesAreAffine) {
  EXPECT_DOUBLE_EQ((Magnitude(12.0) - Magnitude(10.0)).value(), 2.0);
  EXPECT_DOUBLE_EQ((Magnitude(12.0) + DeltaMag(0.38)).value(), 12.38);
  static_assert(!Addable<Magnitude, Magnitude>);
}

TEST(Units, WrongCombinationsDoNotCompile) {
  static_assert(!Addable<Electrons, Adu>);
  static_assert(!Addable<Seconds, Pixels>);
  static_assert(!Multipliable<Electrons, Electrons>);
  static_assert(!std::is_convertible_v<double, Electrons>);
  static_assert(!std::is_convertible_v<Quantity<unit::ExpectedElectrons>, Quantity<unit::SampledElectrons>>);
}

}  // namespace
}  // namespace astroid
