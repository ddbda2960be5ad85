// docs/flags.md names every flag with its number.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
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
    const std::string code = text_of(test::source_dir() / header);
    const std::regex definition(R"(inline constexpr std::uint\d+_t (k\w+) = (\d+)(?:U << (\d+))?;)");
    for (std::sregex_iterator it(code.begin(), code.end(), definition), end; it != end; ++it, ++flags) {
      const long value = (*it)[3].matched ? 1L << std::stol((*it)[3]) : std::stol((*it)[2]);
      const std::string row = "| " + std::to_string(value) + " | `" + (*it)[1].str() + "` |";
      EXPECT_NE(page.find(row), std::string::npos) << row << " is not in docs/flags.md";
    }
  }
  EXPECT_EQ(flags, 10) << "seven measurement flags and three pixel flags: were the definitions found?";
}

}  // namespace
}  // namespace astroid
