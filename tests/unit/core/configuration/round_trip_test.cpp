// The product config.xml reads back to the same mission, and carries origins.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::FolderWithCatalogue;
using test::minimal_xml;
using test::read_text;
using testing::HasSubstr;

TEST(ConfigurationRoundTrip, KeepsThePlatoPreset) {
  const FolderWithCatalogue data;
  const auto first = read_configuration(test::plato_preset(), {.overrides = {}, .data_folders = {data.path()}});
  const auto second = read_text(to_xml(first), data);
  EXPECT_EQ(first.mission, second.mission);
  EXPECT_EQ(first.parameters.size(), second.parameters.size());
}

TEST(ConfigurationRoundTrip, KeepsAMinimalConfiguration) {
  const FolderWithCatalogue data;
  const auto first = read_text(minimal_xml(), data);
  EXPECT_EQ(read_text(to_xml(first), data).mission, first.mission);
}

// Values without an exact binary form, converted units, fractions of a percentage, and every optional parameter.
TEST(ConfigurationRoundTrip, KeepsEveryBitOfAwkwardValues) {
  const FolderWithCatalogue data;
  data.write("a & b <\"c\"> -- d.csv", "");
  const auto first =
      read_text(minimal_xml(), data,
                {"CCD/DSNU=7", "CCD/PRNU=0.29 %", "Simulation/Cycle=12345.6789 ms",
                 "Satellite/Pointing/RA=1.2345678901234567 rad", "Simulation/ExposureTime=0.1", "CCD/SubField/x=1",
                 "CCD/SubField/y=2", "CCD/SubField/columns=3", "CCD/SubField/rows=4", "Output/Images=every 7",
                 "Output/DumpSteps=0 3", "Simulation/Exposures=5", "Simulation/Start=2027-03-04T05:06:07.89",
                 "StellarField/BackgroundCatalogue=a & b <\"c\"> -- d.csv", "CCD/OpticalAxis/X=0.30000000000000004",
                 "Analysis/UncontaminatedSPR=333.3 ppm", "CCD/Blooming=off"});
  const auto second = read_text(to_xml(first), data);
  EXPECT_EQ(first.mission, second.mission);
  EXPECT_EQ(first.parameters.size(), second.parameters.size());
  EXPECT_EQ(second.mission.ccd.axis_x, 0.30000000000000004);
  EXPECT_EQ(second.mission.output.images_every, 7);
}

TEST(ConfigurationRoundTrip, ReachesAFixedPointInItsValues) {
  const FolderWithCatalogue data;
  const auto first = read_text(minimal_xml(), data, {"Simulation/Cycle=12345.6789 ms", "Simulation/ExposureTime=1"});
  const auto second = read_text(to_xml(first), data);
  const auto third = read_text(to_xml(second), data);
  EXPECT_EQ(to_xml(second), to_xml(third));
}

TEST(ConfigurationProduct, StatesTheOriginOfEveryParameter) {
  const FolderWithCatalogue data;
  const std::string xml = to_xml(read_text(minimal_xml("<Telescope><ZeroPoint unit=\"mag\">20</ZeroPoint></Telescope>"),
                                           data, {"CCD/Gain=25", "Satellite/Jitter/model=red-noise"}));
  EXPECT_THAT(xml, HasSubstr("    <Columns origin=\"test.xml:4\">100</Columns>\n"));
  EXPECT_THAT(xml, HasSubstr("    <Bias unit=\"ADU\" origin=\"default\">0</Bias>\n"));
  EXPECT_THAT(xml, HasSubstr("    <Gain unit=\"e-/ADU\" origin=\"--set\">25</Gain>\n"));
  EXPECT_THAT(
      xml, HasSubstr("<ZeroPoint unit=\"mag\" passband=\"P\" origin=\"test.xml:5; passband: default\">20</ZeroPoint>"));
  EXPECT_THAT(xml, HasSubstr("  <Jitter model=\"red-noise\" origin=\"--set\">\n"));
}

TEST(ConfigurationProduct, LeavesOutWhatIsNotSet) {
  const std::string xml = to_xml(read_text(minimal_xml(), FolderWithCatalogue()));
  EXPECT_THAT(xml, testing::Not(HasSubstr("SubField")));
  EXPECT_THAT(xml, testing::Not(HasSubstr("<File")));
}

}  // namespace
}  // namespace astroid
