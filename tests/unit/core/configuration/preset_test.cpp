// The shipped presets: what they say arrives in the Mission, with its origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "astroid/core/configuration.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/error.hpp"
#include "configuration_fixture.hpp"

namespace astroid {
namespace {

using test::FolderWithCatalogue;
using test::plato_preset;

TEST(PlatoPreset, FillsEveryPartOfTheMission) {
  const FolderWithCatalogue data;
  const Mission m = read_configuration(plato_preset(), {.overrides = {}, .data_folders = {data.path()}}).mission;
  EXPECT_EQ(m.simulation.type, DetectorType::kCcd);
  EXPECT_EQ(m.simulation.seed, 42U);
  EXPECT_EQ(m.simulation.exposures, 576);
  EXPECT_EQ(m.simulation.cycle, Seconds(25));
  EXPECT_EQ(m.simulation.exposure_time, Seconds(21));
  EXPECT_EQ(m.simulation.start_mjd, 61406.0);
  EXPECT_EQ(m.satellite.ra, Degrees(95.3104));
  EXPECT_EQ(m.satellite.dec, Degrees(-47.8869));
  EXPECT_EQ(m.satellite.jitter.model, JitterModel::kRedNoise);
  EXPECT_EQ(m.satellite.jitter.roll, Arcseconds(0.040));
  EXPECT_EQ(m.satellite.jitter.timescale, Seconds(250));
  EXPECT_EQ(m.telescope.zero_point, Magnitude(20.62));
  EXPECT_EQ(m.telescope.zero_point_passband, "P");
  EXPECT_EQ(m.telescope.cameras, 24);
  EXPECT_EQ(m.telescope.simulated_cameras, 1);
  EXPECT_EQ(m.psf.sigma, Pixels(0.6));
  EXPECT_EQ(m.field.catalogue, (data.path() / test::kPlatoCatalogue).string());
  EXPECT_EQ(m.field.background_catalogue, (data.path() / test::kPlatoBackground).string());
  EXPECT_EQ(m.field.catalogue_passband, "V_T");
  EXPECT_EQ(m.field.sky_background, ElectronsPerSecond(45));
  EXPECT_EQ(m.ccd.columns, 4510);
  EXPECT_TRUE(m.ccd.has_sub_field);
  EXPECT_EQ(m.ccd.sub_x0, 1755);
  EXPECT_EQ(m.ccd.sub_rows, 1000);
  EXPECT_EQ(m.ccd.axis_x, 2254.5);
  EXPECT_EQ(m.ccd.dsnu, 0.15);
  EXPECT_EQ(m.ccd.prnu, 0.01);
  EXPECT_EQ(m.ccd.readout_noise, Electrons(50.2));
  EXPECT_EQ(m.ccd.gain, Gain(25));
  EXPECT_EQ(m.photometry.method, PhotometryMethod::kMask);
  EXPECT_EQ(m.output.images, ImageOutput::kFirst);
}

TEST(PlatoPreset, FindsTheCatalogueShippedInTheSourceTree) {
  const auto resolved = read_configuration(plato_preset(), {.overrides = {}, .data_folders = {test::source_dir()}});
  EXPECT_EQ(resolved.mission.field.catalogue, (test::source_dir() / test::kPlatoCatalogue).string());
}

// Gutierrez-Canales et al., A&A 707, A2: 24,192 exposures of 25 s of 2 x 2 deg, photometry of 32,240 stars to V = 15.
TEST(WeekPreset, IsThePapersWeekWithTheCameraOfPlato) {
  const ConfigurationSurroundings shipped{.overrides = {}, .data_folders = {test::source_dir()}};
  const Mission week = read_configuration(test::week_preset(), shipped).mission;
  EXPECT_EQ(week.simulation.exposures, 24192);
  EXPECT_EQ(static_cast<double>(week.simulation.exposures) * week.simulation.cycle.value(), 7.0 * 86400.0);
  EXPECT_FALSE(week.ccd.has_sub_field);
  EXPECT_EQ(week.ccd.columns * week.ccd.pixel_scale.value(), 2.0 * 3600.0);
  EXPECT_EQ(week.ccd.rows, week.ccd.columns);
  EXPECT_EQ(week.photometry.method, PhotometryMethod::kMask);
  EXPECT_EQ(week.photometry.background, BackgroundMethod::kLocal);
  EXPECT_EQ(week.photometry.target_limit, Magnitude(15.0));
  EXPECT_EQ(week.output.images, ImageOutput::kNone);
  EXPECT_EQ(week.output.light_curves, LightCurveOutput::kAll);

  const Mission plato = read_configuration(plato_preset(), shipped).mission;
  EXPECT_EQ(week.satellite.jitter.model, plato.satellite.jitter.model);
  EXPECT_EQ(week.satellite.jitter.yaw, plato.satellite.jitter.yaw);
  EXPECT_EQ(week.telescope.zero_point, plato.telescope.zero_point);
  EXPECT_EQ(week.telescope.cameras, plato.telescope.cameras);
  EXPECT_EQ(week.psf.sigma, plato.psf.sigma);
  EXPECT_EQ(week.field.sky_background, plato.field.sky_background);
  EXPECT_EQ(week.ccd.full_well, plato.ccd.full_well);
  EXPECT_EQ(week.ccd.dark_current, plato.ccd.dark_current);
  EXPECT_EQ(week.ccd.dsnu, plato.ccd.dsnu);
  EXPECT_EQ(week.ccd.prnu, plato.ccd.prnu);
  EXPECT_EQ(week.ccd.readout_noise, plato.ccd.readout_noise);
  EXPECT_EQ(week.ccd.gain, plato.ccd.gain);
  EXPECT_EQ(week.ccd.bias, plato.ccd.bias);
  EXPECT_EQ(week.ccd.adc_bits, plato.ccd.adc_bits);
}

// Kubik et al. 2025, arXiv:2507.11326, abstract: 0.52 ADU/e-, reset noise 23 ADU, readout noise of a frame 13 e-,
// coupling of neighbours below 1 %.
TEST(CmosPreset, HasTheDetectorOfItsSource) {
  const ConfigurationSurroundings shipped{.overrides = {}, .data_folders = {test::source_dir()}};
  const Mission cmos = read_configuration(test::cmos_preset(), shipped).mission;
  EXPECT_EQ(cmos.simulation.type, DetectorType::kCmos);
  EXPECT_NEAR(1.0 / cmos.ccd.gain.value(), 0.52, 0.005);
  EXPECT_NEAR((cmos.cmos.reset_noise / cmos.ccd.gain).value(), 23.0, 0.5);
  EXPECT_EQ(cmos.ccd.readout_noise, Electrons(13.0));
  EXPECT_LT(cmos.cmos.coupling, 0.01);
  // What the fit of its reads leaves in the dark: Vacca2004, 13 e- sqrt(12 (R - 1) / (R (R + 1))) of R = 16.
  Mission dark = cmos;
  dark.field.sky_background = ElectronsPerSecond(0.0);
  dark.ccd.dark_current = ElectronsPerSecond(0.0);
  EXPECT_NEAR(dark.ccd.readout_noise.value() * fitted_readout_factor(dark), 10.576, 0.001);
  // Fields of both presets are the same, through the same optics.
  const Mission plato = read_configuration(plato_preset(), shipped).mission;
  EXPECT_EQ(cmos.telescope.zero_point, plato.telescope.zero_point);
  EXPECT_EQ(cmos.psf.sigma, plato.psf.sigma);
  EXPECT_EQ(cmos.field, plato.field);
  EXPECT_EQ(cmos.ccd.pixel_scale, plato.ccd.pixel_scale);
}

// Rauer et al. 2014, Exp. Astron. 38, 249: four groups with a line of sight offset by 9.2 deg; a cycle of 25 s between
// them.
TEST(GroupsPreset, HasTheCamerasOfPlatoInFourGroups) {
  const ConfigurationSurroundings shipped{.overrides = {}, .data_folders = {test::source_dir()}};
  const Mission groups = read_configuration(test::groups_preset(), shipped).mission;
  EXPECT_EQ(groups.telescope.cameras, 24);
  EXPECT_EQ(groups.telescope.groups.cameras, (std::vector<int>{6, 6, 6, 6}));
  EXPECT_EQ(groups.telescope.groups.tilt, (std::vector<double>{9.2, 9.2, 9.2, 9.2}));
  EXPECT_EQ(groups.telescope.groups.stagger, (std::vector<double>{0.0, 6.25, 12.5, 18.75}));
  // What a camera is apart from its group is what plato.xml says.
  Mission plato = read_configuration(plato_preset(), shipped).mission;
  EXPECT_EQ(groups.satellite, plato.satellite);
  EXPECT_EQ(groups.psf, plato.psf);
  EXPECT_EQ(groups.field, plato.field);
  EXPECT_EQ(groups.photometry, plato.photometry);
  plato.ccd.axis_x = groups.ccd.axis_x;
  plato.ccd.axis_y = groups.ccd.axis_y;
  plato.ccd.sub_x0 = groups.ccd.sub_x0;
  plato.ccd.sub_y0 = groups.ccd.sub_y0;
  plato.ccd.sub_columns = groups.ccd.sub_columns;
  plato.ccd.sub_rows = groups.ccd.sub_rows;
  EXPECT_EQ(groups.ccd, plato.ccd);
}

class Preset : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Preset, FindsItsCataloguesInTheSourceTree) {
  const auto resolved = read_configuration(GetParam(), {.overrides = {}, .data_folders = {test::source_dir()}});
  for (const std::string& catalogue : {resolved.mission.field.catalogue, resolved.mission.field.background_catalogue}) {
    EXPECT_TRUE(catalogue.empty() || std::filesystem::is_regular_file(catalogue)) << catalogue;
  }
}

TEST_P(Preset, NamesTheLineOfEveryParameterItGives) {
  const auto resolved = read_configuration(GetParam(), {.overrides = {}, .data_folders = {test::source_dir()}});
  std::vector<std::string> lines;
  std::ifstream stream(GetParam());
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  int from_file = 0;
  for (const ResolvedParameter& parameter : resolved.parameters) {
    if (parameter.origin == "default") continue;
    const std::string prefix = GetParam().string() + ":";
    ASSERT_TRUE(parameter.origin.starts_with(prefix)) << parameter.path << " from " << parameter.origin;
    const auto line = static_cast<std::size_t>(std::stoul(parameter.origin.substr(prefix.size())));
    ASSERT_LE(line, lines.size());
    const std::string name = parameter.path.substr(parameter.path.rfind('/') + 1);
    EXPECT_NE(lines[line - 1].find(name), std::string::npos) << parameter.path << " is not on line " << line;
    ++from_file;
  }
  EXPECT_GE(from_file, 40);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Preset,
                         testing::Values(plato_preset(), test::week_preset(), test::groups_preset(),
                                         test::cmos_preset()));

}  // namespace
}  // namespace astroid
