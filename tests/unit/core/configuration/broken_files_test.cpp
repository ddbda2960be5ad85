// Every file bad/<case>.xml must be refused with exactly the messages of bad/<case>.expected, one problem a line.
// ASTROID_UPDATE_EXPECTED=1 rewrites them: read the difference before committing it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::problems_of;

std::filesystem::path bad_folder() {
  return test::source_dir() / "tests/unit/core/configuration/bad";
}

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(bad_folder())) {
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::string without_folder(std::string text) {
  const std::string folder = bad_folder().string() + "/";
  for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) text.erase(at, folder.size());
  return text;
}

class BrokenConfiguration : public testing::TestWithParam<std::string> {};

TEST_P(BrokenConfiguration, IsRefusedWithTheExpectedMessages) {
  const std::filesystem::path file = bad_folder() / (GetParam() + ".xml");
  const std::filesystem::path expected = bad_folder() / (GetParam() + ".expected");
  const std::string problems = problems_of([&] { return read_configuration(file); });
  EXPECT_NE(problems, "no error");
  const std::string text = without_folder(problems) + "\n";
  if (std::getenv("ASTROID_UPDATE_EXPECTED") != nullptr) std::ofstream(expected, std::ios::binary) << text;
  EXPECT_EQ(text, content(expected));
}

INSTANTIATE_TEST_SUITE_P(Cases, BrokenConfiguration, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param; });

TEST(BrokenConfigurations, AreAtLeastForty) {
  EXPECT_GE(cases().size(), 40U);
}

TEST(BrokenConfigurations, IncludeAFileThatIsNotThere) {
  EXPECT_EQ(problems_of([] { return read_configuration("no/such/file.xml"); }),
            "no/such/file.xml: cannot be read: No such file or directory");
}

TEST(BrokenConfigurations, IncludeAFolder) {
  EXPECT_EQ(without_folder(problems_of([] { return read_configuration(bad_folder()); })),
            bad_folder().string() + ": a folder, not a configuration file");
}

}  // namespace
}  // namespace astroid
