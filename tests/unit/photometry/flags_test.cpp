// docs/flags.md names every flag with its number.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Flags, AreAllDocumented) {
  const std::string page = text_of(test::source_dir() / "docs/flags.md");
  int flags = 0;
  for (const char* header :
       {"photometry/include/astroid/photometry/estimator.hpp", "core/include/astroid/core/frame.hpp"}) {
    // Lines like "inline constexpr std::uint32_t kEdge = 1U << 0;" and "… std::uint8_t kBad = 4;".
    std::istringstream lines(text_of(test::source_dir() / header));
    for (std::string line; std::getline(lines, line);) {
      const auto name = line.find("_t k");
      const auto equals = line.find(" = ");
      if (line.rfind("inline constexpr std::uint", 0) != 0 || name == std::string::npos) continue;
      const auto shift = line.find("U << ");
      const long value =
          shift == std::string::npos ? std::stol(line.substr(equals + 3)) : 1L << std::stol(line.substr(shift + 5));
      const std::string row = "| " + std::to_string(value) + " | `" + line.substr(name + 3, equals - name - 3) + "` |";
      EXPECT_NE(page.find(row), std::string::npos) << row << " is not in docs/flags.md";
      ++flags;
    }
  }
  EXPECT_EQ(flags, 17) << "twelve measurement flags and five pixel flags: were the definitions found?";
}

}  // namespace
}  // namespace astroid
