// How values are written: units, numbers, words, times, files.
#include <gtest/gtest.h>

#include <numbers>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::FolderWithCatalogue;
using test::minimal_xml;
using test::problems_of;
using test::read_text;

Mission with(const std::string& more) {
  return read_text(minimal_xml(more), FolderWithCatalogue()).mission;
}

std::string simulation(const std::string& content) {
  return "<Simulation>" + content + "</Simulation>";
}

TEST(ConfigurationUnits, AreConvertedToTheDocumentedOne) {
  const Mission m = with(simulation("<Cycle unit=\"min\">2</Cycle><ExposureTime unit=\"ms\">100</ExposureTime>") +
                         "<PSF><Sigma unit=\"px\">1</Sigma></PSF><Analysis><Bin unit=\"h\">6.5</Bin>"
                         "<UncontaminatedSPR unit=\"%\">2</UncontaminatedSPR></Analysis>");
  EXPECT_EQ(m.simulation.cycle, Seconds(120));
  EXPECT_EQ(m.simulation.exposure_time, Seconds(0.1));
  EXPECT_EQ(m.analysis.bin, Seconds(23400));
  EXPECT_EQ(m.analysis.uncontaminated_spr, 0.02);
}

TEST(ConfigurationUnits, OfAnglesAreConvertedBothWays) {
  const FolderWithCatalogue data;
  const Mission m = read_text(minimal_xml("<PSF/>"), data,
                              {"Satellite/Pointing/RA=1 rad", "Satellite/Pointing/Dec=-30 arcmin",
                               "Satellite/Jitter/Yaw=40 mas", "Satellite/Jitter/Pitch=0.001 deg"})
                        .mission;
  EXPECT_DOUBLE_EQ(m.satellite.ra.value(), 180.0 / std::numbers::pi);
  EXPECT_EQ(m.satellite.dec, Degrees(-0.5));
  EXPECT_EQ(m.satellite.jitter.yaw, Arcseconds(0.04));
  EXPECT_DOUBLE_EQ(m.satellite.jitter.pitch.value(), 3.6);
}

TEST(ConfigurationNumbers, MayHaveASignAnExponentAndBlanksAround) {
  const Mission m = with(simulation("<Cycle unit=\"s\">\n  +2.5e1\t</Cycle><Exposures> +7 </Exposures>"));
  EXPECT_EQ(m.simulation.cycle, Seconds(25));
  EXPECT_EQ(m.simulation.exposures, 7);
}

TEST(ConfigurationNumbers, MayBeInACdataSectionAndBesideComments) {
  const Mission m = with(simulation("<Seed><!-- lucky --><![CDATA[ 12 ]]></Seed><?editor hint?>"));
  EXPECT_EQ(m.simulation.seed, 12U);
}

TEST(ConfigurationNumbers, ReachTheEndsOfTheirRange) {
  const Mission m = with(simulation("<Seed>9223372036854775807</Seed><Exposures>1</Exposures>"));
  EXPECT_EQ(m.simulation.seed, 9223372036854775807U);
}

TEST(ConfigurationBooleans, HaveFourSpellingsEach) {
  for (const std::string word : {"on", "true", "yes", "1"}) {
    EXPECT_TRUE(with("<Photometry><Calibration><Gain>" + word + "</Gain></Calibration></Photometry>")
                    .photometry.calibration.gain);
  }
  for (const std::string word : {"off", "false", "no", "0"}) {
    EXPECT_FALSE(with("<Photometry><Calibration><Gain>" + word + "</Gain></Calibration></Photometry>")
                     .photometry.calibration.gain);
  }
}

TEST(ConfigurationChoices, ReachTheirEnumerators) {
  const auto method = [](const std::string& word) {
    return with("<Photometry><Method>" + word + "</Method></Photometry>").photometry.method;
  };
  EXPECT_EQ(method("aperture"), PhotometryMethod::kAperture);
  EXPECT_EQ(method("mask"), PhotometryMethod::kMask);
  EXPECT_EQ(method("weighted"), PhotometryMethod::kWeighted);
  EXPECT_EQ(method("psf"), PhotometryMethod::kPsf);
  const auto background = [](const std::string& word) {
    return with("<Photometry><Background>" + word + "</Background></Photometry>").photometry.background;
  };
  EXPECT_EQ(background("known"), BackgroundMethod::kKnown);
  EXPECT_EQ(background("local"), BackgroundMethod::kLocal);
  EXPECT_EQ(background("mesh"), BackgroundMethod::kMesh);
  const auto curves = [](const std::string& word) {
    return with("<Output><Lightcurves>" + word + "</Lightcurves></Output>").output.light_curves;
  };
  EXPECT_EQ(curves("none"), LightCurveOutput::kNone);
  EXPECT_EQ(curves("targets"), LightCurveOutput::kTargets);
  EXPECT_EQ(curves("all"), LightCurveOutput::kAll);
  EXPECT_EQ(with(simulation("<Type>CMOS</Type>")).simulation.type, DetectorType::kCmos);
}

TEST(ConfigurationChoices, CountWhereTheyAreCounted) {
  const auto output = [](const std::string& words) {
    return with("<Output><Images>" + words + "</Images></Output>").output;
  };
  EXPECT_EQ(output("none").images, ImageOutput::kNone);
  EXPECT_EQ(output("first").images, ImageOutput::kFirst);
  EXPECT_EQ(output("all").images, ImageOutput::kAll);
  EXPECT_EQ(output("every 144").images, ImageOutput::kEvery);
  EXPECT_EQ(output("every  144").images_every, 144);
  EXPECT_EQ(output("all").images_every, 1);
}

TEST(ConfigurationLists, AreSeparatedByBlanksOrCommas) {
  const std::vector<std::int64_t> expected = {0, 3, 12};
  const std::string begin = simulation("<Exposures>20</Exposures>") + "<Output><DumpSteps>";
  EXPECT_EQ(with(begin + "0 3\n12</DumpSteps></Output>").output.dump_steps, expected);
  EXPECT_EQ(with(begin + "0, 3,12</DumpSteps></Output>").output.dump_steps, expected);
  EXPECT_TRUE(with(begin + "</DumpSteps></Output>").output.dump_steps.empty());
}

TEST(ConfigurationTimes, BecomeModifiedJulianDates) {
  EXPECT_EQ(with(simulation("<Start>2000-01-01T12:00:00</Start>")).simulation.start_mjd, 51544.5);
  EXPECT_EQ(with(simulation("<Start>2028-02-29</Start>")).simulation.start_mjd, 61830.0);
}

TEST(ConfigurationSubField, IsAbsentUnlessGiven) {
  EXPECT_FALSE(with("").ccd.has_sub_field);
  const FolderWithCatalogue data;
  const Mission m =
      read_text(minimal_xml(), data,
                {"CCD/SubField/x=90", "CCD/SubField/y=0", "CCD/SubField/columns=10", "CCD/SubField/rows=80"})
          .mission;
  EXPECT_TRUE(m.ccd.has_sub_field);
  EXPECT_EQ(m.ccd.sub_columns, 10);
}

TEST(ConfigurationOpticalAxis, IsInTheCentreUnlessGiven) {
  EXPECT_EQ(with("").ccd.axis_x, 49.5);
  EXPECT_EQ(with("").ccd.axis_y, 39.5);
  const FolderWithCatalogue data;
  const Mission m = read_text(minimal_xml(), data, {"CCD/OpticalAxis/X=-12.5 px", "CCD/Rows=101"}).mission;
  EXPECT_EQ(m.ccd.axis_x, -12.5);
  EXPECT_EQ(m.ccd.axis_y, 50.0);
}

TEST(ConfigurationFiles, AreSoughtBesideTheConfigurationThenInTheDataFolders) {
  const FolderWithCatalogue beside;
  const FolderWithCatalogue data;
  data.write("faint.csv", "ra,dec,mag\n");
  data.write("stars.csv", "ra,dec,mag\n");
  const auto file = beside.write(
      "mission.xml",
      "<Astroid version=\"1\"><Satellite><Pointing><RA unit=\"deg\">10</RA><Dec unit=\"deg\">5</Dec></Pointing>"
      "</Satellite><StellarField><Catalogue>./stars.csv</Catalogue>"
      "<BackgroundCatalogue>faint.csv</BackgroundCatalogue></StellarField>"
      "<CCD><Columns>9</Columns><Rows>8</Rows></CCD></Astroid>");
  const Mission m = read_configuration(file, {.overrides = {}, .data_folders = {data.path()}}).mission;
  EXPECT_EQ(m.field.catalogue, (beside.path() / "stars.csv").string());
  EXPECT_EQ(m.field.background_catalogue, (data.path() / "faint.csv").string());
}

TEST(ConfigurationFiles, MayBeAbsolute) {
  const FolderWithCatalogue data;
  const std::string name = (data.path() / "stars.csv").string();
  const FolderWithCatalogue elsewhere;
  EXPECT_EQ(read_text(minimal_xml(), elsewhere, {"StellarField/Catalogue=" + name}).mission.field.catalogue, name);
}

TEST(ConfigurationLines, AreRightBeyondSixteenBits) {
  const std::string many_lines(70000, '\n');
  const std::string text = problems_of(
      [&] { return read_text(minimal_xml(many_lines + simulation("<Seed>x</Seed>")), FolderWithCatalogue()); });
  EXPECT_EQ(text, "test.xml:70005: Simulation/Seed = x: not a number; expected an integer, at least 0");
}

TEST(ConfigurationSchemaLocation, IsLeftToTheEditor) {
  const std::string root =
      "<Astroid version=\"1\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:noNamespaceSchemaLocation=\"astroid.xsd\">";
  std::string xml = minimal_xml();
  xml.replace(0, xml.find('\n'), root);
  EXPECT_EQ(problems_of([&] { return read_text(xml, FolderWithCatalogue()); }), "no error");
}

}  // namespace
}  // namespace astroid
