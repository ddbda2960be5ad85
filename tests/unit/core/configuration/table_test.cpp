// The parameter table as data: complete, consistent, and in agreement with the defaults of Mission.
#include <gtest/gtest.h>

#include <set>

#include "configuration_fixture.hpp"
#include "configuration_names.hpp"
#include "configuration_parameter.hpp"
#include "configuration_units.hpp"
#include "configuration_value.hpp"

namespace astroid::configuration {
namespace {

TEST(ParameterTable, DocumentsEveryParameter) {
  std::set<std::string_view> paths;
  for (const Parameter& parameter : parameter_table()) {
    EXPECT_TRUE(paths.insert(parameter.path).second) << parameter.path << " is there twice";
    EXPECT_GT(parameter.meaning.size(), 10U) << parameter.path;
    EXPECT_TRUE(parameter.meaning.ends_with('.')) << parameter.path;
    EXPECT_FALSE(parameter.example.empty()) << parameter.path;
    EXPECT_NE(parameter.assign, nullptr) << parameter.path;
    EXPECT_EQ(parameter.choices.empty(), parameter.kind != Kind::kChoice) << parameter.path;
    for (std::string_view parent = parent_path(parameter.path); !parent.empty(); parent = parent_path(parent)) {
      EXPECT_TRUE(is_section(parent) || find_parameter(parent) != nullptr) << parent << " has no meaning";
    }
  }
  EXPECT_GE(paths.size(), 60U);
}

TEST(ParameterTable, BoundsEveryNumber) {
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.kind != Kind::kReal && parameter.kind != Kind::kInteger) continue;
    EXPECT_FALSE(range_text(parameter.range).empty()) << parameter.path;
  }
}

TEST(ParameterTable, HasExamplesAndDefaultsThatItAccepts) {
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.kind == Kind::kFile) continue;
    const ParsedValue example = parse_value(parameter, parameter.example, parameter.unit, {});
    EXPECT_FALSE(example.error.has_value()) << parameter.path << ": " << example.error->message;
    if (parameter.fallback.empty()) continue;
    const ParsedValue fallback = parse_value(parameter, parameter.fallback, parameter.unit, {});
    ASSERT_FALSE(fallback.error.has_value()) << parameter.path << ": " << fallback.error->message;
    EXPECT_EQ(fallback.value.text, parameter.fallback) << parameter.path << ": not in canonical form";
  }
}

TEST(ParameterTable, UsesOnlyKnownUnits) {
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.unit.empty()) continue;
    const UnitConversion* identity = find_conversion(parameter.unit, parameter.unit);
    ASSERT_NE(identity, nullptr) << parameter.path << ": " << parameter.unit;
    EXPECT_EQ(identity->multiply / identity->divide, 1.0);
  }
}

// The struct's initialisers and the table's defaults say the same, so code that builds a Mission by hand and a
// configuration that leaves things out mean the same instrument.
TEST(ParameterTable, AgreesWithTheDefaultsOfMission) {
  const test::FolderWithCatalogue data;
  const Mission read = test::read_text(test::minimal_xml(), data).mission;
  Mission expected;
  expected.satellite.ra = Degrees(10);
  expected.satellite.dec = Degrees(-5);
  expected.field.catalogue = (data.path() / "stars.csv").string();
  expected.ccd.columns = 100;
  expected.ccd.rows = 80;
  expected.ccd.axis_x = 49.5;
  expected.ccd.axis_y = 39.5;
  EXPECT_EQ(read.simulation, expected.simulation);
  EXPECT_EQ(read.satellite, expected.satellite);
  EXPECT_EQ(read.telescope, expected.telescope);
  EXPECT_EQ(read.psf, expected.psf);
  EXPECT_EQ(read.field, expected.field);
  EXPECT_EQ(read.ccd, expected.ccd);
  EXPECT_EQ(read.photometry, expected.photometry);
  EXPECT_EQ(read.analysis, expected.analysis);
  EXPECT_EQ(read.output, expected.output);
}

// Each parameter reaches a place of its own: changing one changes the Mission.
TEST(ParameterTable, BindsEveryParameterToTheMission) {
  for (const Parameter& parameter : parameter_table()) {
    Mission mission;
    mission.ccd.columns = mission.ccd.rows = 7;
    const Mission before = mission;
    Value other;
    other.real = 0.123;
    other.integer = 3;
    other.text = "other";
    other.integers = {3};
    other.reals = {0.123};
    for (const std::size_t choice : {0U, 1U}) {
      other.choice = choice;
      other.flag = choice == 1;
      parameter.assign(mission, other);
      if (!(mission == before)) break;
    }
    EXPECT_FALSE(mission == before) << parameter.path << " changes nothing";
  }
}

TEST(DamerauLevenshtein, CountsEditsAndSwaps) {
  EXPECT_EQ(damerau_levenshtein("", "abc"), 3U);
  EXPECT_EQ(damerau_levenshtein("gain", "Gain"), 0U);
  EXPECT_EQ(damerau_levenshtein("kitten", "sitting"), 3U);
  EXPECT_EQ(damerau_levenshtein("noise", "nosie"), 1U);
  EXPECT_EQ(damerau_levenshtein("CA", "ABC"), 3U);  // the optimal string alignment distance
  EXPECT_EQ(damerau_levenshtein("abcdef", "abcdef"), 0U);
}

TEST(NearestName, NeedsTwoThirdsOfTheLetters) {
  const std::vector<std::string> names = {"ReadoutNoise", "Rows", "RA", "x"};
  EXPECT_EQ(nearest_name("ReadoutNosie", names), "ReadoutNoise");
  EXPECT_EQ(nearest_name("Readout", names), "ReadoutNoise");
  EXPECT_EQ(nearest_name("row", names), "Rows");
  EXPECT_EQ(nearest_name("Quasars", names), "");
  EXPECT_EQ(nearest_name("y", names), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'R'), names), "");
}

}  // namespace
}  // namespace astroid::configuration
