// Every file of broken/ is refused with exactly the text of its .expected file, whose first line states the options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

std::filesystem::path broken_folder() {
  return test::source_dir() / "tests/unit/catalogues/broken";
}

std::vector<std::string> broken_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(broken_folder())) {
    if (entry.path().extension() != ".expected") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct Expectation {
  CatalogueOptions options;
  std::string text;
};

Expectation read_expectation(const std::string& name) {
  std::ifstream file(broken_folder() / (name + ".expected"));
  std::string first;
  std::getline(file, first);
  Expectation expectation;
  std::istringstream words(first);
  for (std::string word; words >> word;) {
    if (word.starts_with("passband=")) expectation.options.passband = word.substr(word.find('=') + 1);
    if (word == "unit=rad") expectation.options.unit = AngleUnit::kRadians;
  }
  std::ostringstream rest;
  rest << file.rdbuf();
  expectation.text = rest.str();
  return expectation;
}

std::string without_folder(std::string text) {
  const std::string folder = broken_folder().string() + "/";
  for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) text.erase(at, folder.size());
  return text;
}

class BrokenCatalogue : public testing::TestWithParam<std::string> {};

TEST_P(BrokenCatalogue, IsRefusedWithTheExpectedText) {
  const Expectation expectation = read_expectation(GetParam());
  std::string text;
  try {
    (void)read_catalogue(broken_folder() / GetParam(), expectation.options);
  } catch (const InputError& error) {
    text = without_folder(error.what()) + "\n";
  }
  EXPECT_EQ(text, expectation.text);
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenCatalogue, testing::ValuesIn(broken_files()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

TEST(BrokenCatalogues, AreMany) {
  EXPECT_GE(broken_files().size(), 25U);
}

TEST(MissingCatalogue, IsAnEnvironmentErrorThatNamesTheFile) {
  try {
    (void)read_catalogue("/nonexistent/stars.csv", {});
    FAIL() << "read";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/nonexistent/stars.csv"));
  }
}

}  // namespace
}  // namespace astroid
