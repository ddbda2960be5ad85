// The generated schema, judged by xmllint where it is installed.
#include <gtest/gtest.h>

#include <cstdlib>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::FolderWithCatalogue;
using test::minimal_xml;
using test::read_text;

class Schema : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("xmllint --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "xmllint is not installed";
    folder_.write("astroid.xsd", generate_xsd());
  }

  [[nodiscard]] bool accepts_file(const std::filesystem::path& file) const {
    const std::string command = "xmllint --nonet --noout --schema '" + (folder_.path() / "astroid.xsd").string() +
                                "' '" + file.string() + "' > /dev/null 2>&1";
    return std::system(command.c_str()) == 0;
  }

  [[nodiscard]] bool accepts(const std::string& xml) const { return accepts_file(folder_.write("test.xml", xml)); }

  test::TemporaryFolder folder_;
};

TEST_F(Schema, AcceptsTheShippedPresets) {
  int presets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "apps/missions")) {
    if (entry.path().extension() != ".xml") continue;
    EXPECT_TRUE(accepts_file(entry.path())) << entry.path();
    ++presets;
  }
  EXPECT_GE(presets, 1);
}

TEST_F(Schema, AcceptsAMinimalConfigurationAndTheProduct) {
  EXPECT_TRUE(accepts(minimal_xml()));
  EXPECT_TRUE(accepts(to_xml(read_text(minimal_xml(), FolderWithCatalogue()))));
}

TEST_F(Schema, AcceptsAlternativeUnitsKeywordsAndCountedChoices) {
  EXPECT_TRUE(
      accepts(minimal_xml("<Simulation><Cycle unit=\"ms\">25000</Cycle></Simulation>"
                          "<Output><Images> every 12 </Images></Output>")));
  std::string xml = minimal_xml();
  xml.insert(xml.find("</CCD>"), "<OpticalAxis><X unit=\"px\">centre</X><Y unit=\"px\">-3.5</Y></OpticalAxis>");
  EXPECT_TRUE(accepts(xml));
}

TEST_F(Schema, RefusesWhatTheReaderRefuses) {
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Sede>1</Sede></Simulation>"))) << "unknown parameter";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Cycle>25</Cycle></Simulation>"))) << "missing unit";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Cycle unit=\"px\">25</Cycle></Simulation>"))) << "wrong unit";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Cycle unit=\"s\">NaN</Cycle></Simulation>"))) << "NaN";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Cycle unit=\"s\">-1</Cycle></Simulation>"))) << "negative";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Exposures>0</Exposures></Simulation>"))) << "out of range";
  EXPECT_FALSE(accepts(minimal_xml("<Simulation><Start>soon</Start></Simulation>"))) << "bad time";
  EXPECT_FALSE(accepts(minimal_xml("<Output><Images>every 0</Images></Output>"))) << "bad count";
  EXPECT_FALSE(accepts(minimal_xml("<PSF><Model>lorentz</Model></PSF>"))) << "bad choice";
  EXPECT_FALSE(accepts(minimal_xml("<PSF/><PSF/>"))) << "twice";
  EXPECT_FALSE(accepts("<Astroid version=\"1\"/>")) << "missing required";
  std::string other_version = minimal_xml();
  other_version.replace(other_version.find("\"1\""), 3, "\"2\"");
  EXPECT_FALSE(accepts(other_version)) << "version";
}

}  // namespace
}  // namespace astroid
