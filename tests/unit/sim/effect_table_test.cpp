#include "astroid/sim/effect_table.hpp"

#include <gtest/gtest.h>

#include <array>

namespace astroid {
namespace {

constexpr EffectSpec spec(const char* name, std::uint32_t id, EffectLevel level, std::uint32_t reads,
                          std::uint32_t writes) {
  return {name, StreamId{id}, level, reads, writes, 0, RandomScope::kNone, ""};
}

TEST(EffectTable, RefusesAnEffectThatReadsAnUnwrittenPlane) {
  constexpr std::array kTable{spec("a", 1, EffectLevel::kOptics, plane_bit::kStars, plane_bit::kExpected),
                              spec("b", 2, EffectLevel::kReadout, plane_bit::kSampled, plane_bit::kAnalog)};
  EXPECT_FALSE(is_consistent(kTable));
}

TEST(EffectTable, RefusesAStreamNumberThatIsUsedTwice) {
  constexpr std::array kTable{spec("a", 1, EffectLevel::kOptics, plane_bit::kStars, plane_bit::kExpected),
                              spec("b", 1, EffectLevel::kSky, plane_bit::kExpected, plane_bit::kExpected)};
  EXPECT_FALSE(is_consistent(kTable));
}

TEST(EffectTable, RefusesALevelThatStepsBack) {
  constexpr std::array kTable{spec("a", 1, EffectLevel::kSky, plane_bit::kStars, plane_bit::kExpected),
                              spec("b", 2, EffectLevel::kOptics, plane_bit::kExpected, plane_bit::kExpected)};
  EXPECT_FALSE(is_consistent(kTable));
}

TEST(EffectTable, OfTheCcdIsConsistent) {
  std::vector<EffectSpec> specs;
  for (const auto& effect : effect_table(DetectorType::kCcd)) specs.push_back(effect->spec());
  EXPECT_TRUE(is_consistent(specs));
  EXPECT_EQ(specs.front().name, "proper-motion");
  EXPECT_EQ(specs.back().name, "adc");
}

TEST(EffectTable, OfCmosIsConsistentAndReadsBetweenPhotonsAndTheFit) {
  std::vector<EffectSpec> specs;
  for (const auto& effect : effect_table(DetectorType::kCmos)) specs.push_back(effect->spec());
  EXPECT_TRUE(is_consistent(specs));
  // Anything in between that saw an exposure only once would tear the reads apart.
  bool reading = false;
  bool fitted = false;
  for (const EffectSpec& spec : specs) {
    fitted = fitted || spec.name == "ramp-fit";
    reading = (reading || spec.name == "photon-noise") && !fitted;
    EXPECT_EQ(spec.per_read && !fitted, reading) << spec.name;
  }
  EXPECT_TRUE(fitted);
}

}  // namespace
}  // namespace astroid
