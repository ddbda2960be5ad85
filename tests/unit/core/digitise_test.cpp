#include "astroid/core/digitise.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace astroid {
namespace {

struct Digitised {
  float counts;
  std::uint8_t flag;
};
Digitised adc16(double counts) {
  std::uint8_t flag = 0;
  const float value = digitise(counts, adc_top(16), flag);
  return {value, flag};
}

TEST(Digitise, ClampsBeforeItRounds) {
  for (const double high : {65534.6, 65535.4, 65536.0, 1e9, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(adc16(high).counts, 65535.0F) << high;
    EXPECT_EQ(adc16(high).flag, pixel_flag::kAdcSaturated) << high;
  }
  EXPECT_EQ(adc16(-3.0).counts, 0.0F);
  EXPECT_EQ(adc16(-3.0).flag, pixel_flag::kAdcSaturated);
}

TEST(Digitise, FlagsWhatIsNotANumber) {
  EXPECT_EQ(adc16(std::numeric_limits<double>::quiet_NaN()).counts, 0.0F);
  EXPECT_EQ(adc16(std::numeric_limits<double>::quiet_NaN()).flag, pixel_flag::kBad);
}

TEST(Digitise, RoundsHalfToEven) {
  EXPECT_EQ(adc16(2.5).counts, 2.0F);
  EXPECT_EQ(adc16(3.5).counts, 4.0F);
  EXPECT_EQ(adc16(65534.4).counts, 65534.0F);
  EXPECT_EQ(adc16(65534.4).flag, 0);
  EXPECT_EQ(adc16(-0.4).flag, 0);
}

}  // namespace
}  // namespace astroid
