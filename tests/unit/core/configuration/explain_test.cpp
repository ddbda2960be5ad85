// explain, the reference page, and the documented defaults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::problems_of;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Explain, SaysEverythingAboutAParameter) {
  EXPECT_EQ(explain("CCD/ReadoutNoise"),
            "CCD/ReadoutNoise\n"
            "  Rms noise of reading a pixel once, detector and electronics together.\n"
            "  value    number\n"
            "  unit     e- (also ke-)\n"
            "  range    0 to 100000\n"
            "  default  0 e-\n"
            "  example  <ReadoutNoise unit=\"e-\">50.2</ReadoutNoise>\n"
            "           --set CCD/ReadoutNoise=50.2\n");
}

TEST(Explain, ListsChoicesAndQuotesWhatAShellWouldSplit) {
  const std::string text = explain("Output/Images");
  EXPECT_THAT(text, HasSubstr("value    one of none, first, every N, all\n"));
  EXPECT_THAT(text, HasSubstr("default  first\n"));
  EXPECT_THAT(text, HasSubstr("--set 'Output/Images=every 144'\n"));
}

TEST(Explain, ShowsHowAnAttributeIsWritten) {
  const std::string text = explain("Telescope/ZeroPoint/passband");
  EXPECT_THAT(text, HasSubstr("<ZeroPoint passband=\"P\" ...>"));
  EXPECT_THAT(text, HasSubstr("--set Telescope/ZeroPoint/passband=P"));
}

TEST(Explain, FindsByTheLastNameInAnyCase) {
  EXPECT_EQ(explain("readoutnoise"), explain("CCD/ReadoutNoise"));
  const std::string both = explain("passband");
  EXPECT_THAT(both, HasSubstr("Telescope/ZeroPoint/passband\n"));
  EXPECT_THAT(both, HasSubstr("StellarField/Catalogue/passband\n"));
  EXPECT_EQ(explain("Jitter/Yaw"), explain("Satellite/Jitter/Yaw"));
}

TEST(Explain, ListsASection) {
  const std::string text = explain("Satellite/Jitter");
  EXPECT_THAT(text, StartsWith("Satellite/Jitter\n  Attitude noise"));
  EXPECT_THAT(text, HasSubstr("Satellite/Jitter/Timescale"));
  EXPECT_THAT(text, testing::Not(HasSubstr("Satellite/Pointing")));
}

TEST(Explain, ListsEverythingWhenAskedForNothing) {
  const std::string text = explain("");
  for (const char* path : {"Simulation/Type", "CCD/SubField/x", "Output/DumpSteps"}) EXPECT_THAT(text, HasSubstr(path));
}

TEST(Explain, SuggestsTheNearestName) {
  EXPECT_EQ(problems_of([] { return explain("ReadNoise"); }),
            "ReadNoise: no such parameter; did you mean CCD/ReadoutNoise?");
  EXPECT_EQ(problems_of([] { return explain("xyzzy"); }), "xyzzy: no such parameter");
}

TEST(ReferencePage, IsUpToDate) {
  const std::filesystem::path page = test::source_dir() / "docs/configuration.md";
  if (std::getenv("ASTROID_UPDATE_EXPECTED") != nullptr)
    std::ofstream(page, std::ios::binary) << reference_page_markdown();
  std::ostringstream text;
  text << std::ifstream(page, std::ios::binary).rdbuf();
  EXPECT_EQ(text.str(), reference_page_markdown()) << "ASTROID_UPDATE_EXPECTED=1 rewrites it";
}

}  // namespace
}  // namespace astroid
