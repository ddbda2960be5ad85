// Whatever happens to a file, the reader answers with a Mission or an InputError, and nothing else.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <sstream>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

/// A small generator of its own, so that failures repeat (Steele, Lea & Flood 2014, SplitMix64).
class SplitMix {
 public:
  std::size_t below(std::size_t bound) {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<std::size_t>((z ^ (z >> 31U)) % bound);
  }

 private:
  std::uint64_t state_ = 1;
};

std::string mutated(std::string text, SplitMix& random) {
  const std::size_t edits = 1 + random.below(4);
  for (std::size_t i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = random.below(text.size());
    const std::size_t length = std::min(text.size() - at, 1 + random.below(40));
    const std::string piece = text.substr(at, length);
    switch (random.below(4)) {
      case 0:
        text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(random.below(text.size()), piece);
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(DamagedConfiguration, IsReadOrRefusedButNeverCrashes) {
  const test::FolderWithCatalogue data;
  std::ostringstream preset;
  preset << std::ifstream(test::plato_preset()).rdbuf();
  ASSERT_GT(preset.str().size(), 1000U);
  SplitMix random;
  int refused = 0;
  constexpr int kTrials = 3000;
  for (int i = 0; i < kTrials; ++i) {
    try {
      (void)test::read_text(mutated(preset.str(), random), data);
    } catch (const InputError& error) {
      ++refused;
      for (const Problem& problem : error.problems()) {
        ASSERT_EQ(problem.file, "test.xml");
        ASSERT_FALSE(problem.message.empty());
      }
    }
  }
  EXPECT_GT(refused, kTrials / 2);
  EXPECT_LT(refused, kTrials);
}

}  // namespace
}  // namespace astroid
