// --set Path/To/Parameter=value.
#include <gtest/gtest.h>

#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::FolderWithCatalogue;
using test::minimal_xml;
using test::problems_of;
using test::read_text;

Mission with(const std::vector<std::string>& overrides) {
  return read_text(minimal_xml("<Telescope><Cameras>6</Cameras></Telescope>"), FolderWithCatalogue(), overrides)
      .mission;
}

std::string complaint(const std::vector<std::string>& overrides) {
  return problems_of([&] { return with(overrides); });
}

TEST(Override, WinsOverTheFileAndTheDefault) {
  EXPECT_EQ(with({"Telescope/Cameras=12"}).telescope.cameras, 12);
  EXPECT_EQ(with({"CCD/ReadoutNoise=50.2"}).ccd.readout_noise, Electrons(50.2));
}

TEST(Override, MayStateItsUnitWithOrWithoutABlank) {
  EXPECT_EQ(with({"CCD/ReadoutNoise=50.2 e-"}).ccd.readout_noise, Electrons(50.2));
  EXPECT_EQ(with({"CCD/ReadoutNoise=50.2e-"}).ccd.readout_noise, Electrons(50.2));
  EXPECT_EQ(with({"CCD/FullWell=900 ke-"}).ccd.full_well, Electrons(900000));
  EXPECT_EQ(with({"CCD/FullWell=9e5e-"}).ccd.full_well, Electrons(900000));
  EXPECT_EQ(with({"Simulation/ExposureTime=500ms"}).simulation.exposure_time, Seconds(0.5));
  EXPECT_EQ(with({"CCD/PRNU=2%"}).ccd.prnu, 0.02);
}

TEST(Override, ReachesAttributes) {
  EXPECT_EQ(with({"Telescope/ZeroPoint/passband=V"}).telescope.zero_point_passband, "V");
  EXPECT_EQ(with({"Satellite/Jitter/model=red-noise"}).satellite.jitter.model, JitterModel::kRedNoise);
}

TEST(Override, LastOneOfSeveralCounts) {
  EXPECT_EQ(with({"Simulation/Seed=3", "Simulation/Seed=4"}).simulation.seed, 4U);
}

TEST(Override, ToleratesBlanksAroundItsParts) {
  EXPECT_EQ(with({" Simulation/Seed = 3 "}).simulation.seed, 3U);
}

TEST(Override, SuppliesWhatTheFileLacks) {
  const std::string xml =
      "<Astroid version=\"1\"><Satellite><Pointing><RA unit=\"deg\">1</RA></Pointing></Satellite>"
      "<StellarField><Catalogue>stars.csv</Catalogue></StellarField>"
      "<CCD><Columns>9</Columns><Rows>8</Rows></CCD></Astroid>";
  EXPECT_EQ(read_text(xml, FolderWithCatalogue(), {"Satellite/Pointing/Dec=7"}).mission.satellite.dec, Degrees(7));
}

TEST(Override, IsNamedAsTheOrigin) {
  const auto resolved = read_text(minimal_xml(), FolderWithCatalogue(), {"CCD/Gain=25"});
  for (const ResolvedParameter& parameter : resolved.parameters) {
    if (parameter.path == "CCD/Gain") {
      EXPECT_EQ(parameter, (ResolvedParameter{"CCD/Gain", "25", "e-/ADU", "--set"}));
    }
    if (parameter.path == "CCD/Columns") {
      EXPECT_EQ(parameter.origin, "test.xml:4");
    }
    if (parameter.path == "CCD/Bias") {
      EXPECT_EQ(parameter.origin, "default");
    }
  }
}

TEST(Override, IsNamedInItsErrors) {
  EXPECT_EQ(complaint({"CCD/ReadNoise=3"}),
            "--set: CCD/ReadNoise = 3: unknown parameter; did you mean CCD/ReadoutNoise?");
  EXPECT_EQ(complaint({"Gain=3"}),
            "--set: Gain = 3: unknown parameter; did you mean CCD/Gain or Photometry/Calibration/Gain?");
  EXPECT_EQ(complaint({"ccd/gain=3"}), "--set: ccd/gain = 3: unknown parameter; did you mean CCD/Gain?");
  EXPECT_EQ(complaint({"CCD/Gain"}), "--set: CCD/Gain: has no value; expected Path/To/Parameter=value");
  EXPECT_EQ(complaint({"CCD/Gain="}), "--set: CCD/Gain: has no value; expected a number from 0.0001 to 1000000 e-/ADU");
  EXPECT_EQ(complaint({"CCD=3"}), "--set: CCD = 3: a section, not a parameter");
  EXPECT_EQ(complaint({"Quasars=3"}), "--set: Quasars = 3: unknown parameter");
  EXPECT_EQ(complaint({""}), "--set: has no value; expected Path/To/Parameter=value");
}

TEST(Override, RefusesTheWrongUnit) {
  EXPECT_EQ(complaint({"CCD/ReadoutNoise=50 ADU"}),
            "--set: CCD/ReadoutNoise = 50 ADU: \"ADU\" follows the number; expected a number from 0 to 100000 e-");
}

TEST(Override, IsCheckedTogetherWithTheFile) {
  EXPECT_EQ(complaint({"Telescope/SimulatedCameras=8"}),
            "--set: Telescope/SimulatedCameras = 8: more than there are; expected at most Cameras (6)");
  EXPECT_EQ(complaint({"Simulation/Cycle=3"}),
            "--set: Simulation/ExposureTime = 21 s (default): longer than the cycle; expected at most Cycle (3 s)");
}

TEST(Override, IsReportedAfterTheProblemsOfTheFile) {
  const std::string text = problems_of([] {
    return read_text(minimal_xml("<Output><Images>some</Images></Output>"), FolderWithCatalogue(), {"CCD/Gain=zero"});
  });
  EXPECT_EQ(text,
            "test.xml:5: Output/Images = some: not one of the choices; expected one of none, first, every N, all\n"
            "--set: CCD/Gain = zero: not a number; expected a number from 0.0001 to 1000000 e-/ADU");
}

}  // namespace
}  // namespace astroid
