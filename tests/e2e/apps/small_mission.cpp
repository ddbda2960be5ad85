#include "small_mission.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"

namespace astroid::test {

namespace {

constexpr double kRa = 95.3104;
constexpr double kDec = -47.8869;
constexpr double kDegreesPerPixel = 15.0 / 3600.0;
constexpr int kPerSide = 5;

constexpr const char* kConfiguration = R"(<?xml version="1.0" encoding="UTF-8"?>
<Astroid version="1">
  <Simulation>
    <Type>CCD</Type>
    <Seed>7</Seed>
    <Exposures>6</Exposures>
    <Cycle unit="s">25</Cycle>
    <ExposureTime unit="s">21</ExposureTime>
  </Simulation>
  <Satellite>
    <Pointing> <RA unit="deg">95.3104</RA> <Dec unit="deg">-47.8869</Dec> <Roll unit="deg">20</Roll> </Pointing>
    <Jitter model="red-noise">
      <Yaw unit="arcsec">0.038</Yaw> <Pitch unit="arcsec">0.038</Pitch> <Roll unit="arcsec">0.040</Roll>
      <Timescale unit="s">250</Timescale>
    </Jitter>
  </Satellite>
  <Telescope>
    <ZeroPoint unit="mag" passband="P">20.62</ZeroPoint>
    <Cameras>24</Cameras>
    <SimulatedCameras>1</SimulatedCameras>
  </Telescope>
  <PSF> <Model>gaussian</Model> <Sigma unit="px">0.6</Sigma> </PSF>
  <StellarField>
    <Catalogue passband="P">stars.csv</Catalogue>
    <SkyBackground unit="e-/px/s">45</SkyBackground>
  </StellarField>
  <CCD>
    <Columns>100</Columns>
    <Rows>100</Rows>
    <PixelScale unit="arcsec/px">15</PixelScale>
    <FullWell unit="e-">900000</FullWell>
    <DarkCurrent unit="e-/px/s">1.2</DarkCurrent>
    <DSNU unit="%">15</DSNU>
    <PRNU unit="%">1</PRNU>
    <ReadoutNoise unit="e-">50.2</ReadoutNoise>
    <Gain unit="e-/ADU">25</Gain>
    <Bias unit="ADU">1000</Bias>
  </CCD>
  <Photometry>
    <Method>mask</Method>
    <Background>local</Background>
  </Photometry>
  <Analysis> <Bin unit="s">50</Bin> </Analysis>
  <Output> <Images>first</Images> <Lightcurves>targets</Lightcurves> </Output>
</Astroid>
)";

}  // namespace

std::filesystem::path write_small_mission(const TemporaryFolder& folder) {
  std::string stars = "id,ra,dec,mag\n";
  for (int i = 0; i < kPerSide * kPerSide; ++i) {
    constexpr double kSpacing = 14.45;  // px; with the roll all stay on the detector
    const double dx = kSpacing * (i % kPerSide - kPerSide / 2) + 0.23 * (i % 4);
    const double dy = kSpacing * (i / kPerSide - kPerSide / 2) + 0.19 * (i % 5);
    const double dec = kDec + dy * kDegreesPerPixel;
    const double ra = kRa + dx * kDegreesPerPixel / std::cos(dec * M_PI / 180.0);
    char line[128];
    std::snprintf(line, sizeof line, "star%d,%.9f,%.9f,%.2f\n", i, ra, dec, 8.5 + 0.2 * i);
    stars += line;
  }
  folder.write("stars.csv", stars);
  return folder.write("small.xml", kConfiguration);
}

void write_pixel_field(const std::filesystem::path& file, int side, int stars, const std::string& more) {
  constexpr double kFaintest = 4000.0;      // e-
  constexpr double kLeastShare = 1.0 / 99;  // of the faintest star's flux in the brightest: 100 times
  const RandomStream stream = make_stream(14, StreamId{0xf1e1d}, 0, 0);
  std::ofstream lines(file);
  lines << "id,x,y,electrons\n";
  for (int i = 0; i < stars; ++i) {
    const auto step = static_cast<std::uint32_t>(i);
    lines << 's' << i << ',' << side * uniform_at_step(stream, {.step = step, .axis = 0}) - 0.5 << ','
          << side * uniform_at_step(stream, {.step = step, .axis = 1}) - 0.5 << ','
          << kFaintest * (1.0 + kLeastShare) / (uniform_at_step(stream, {.step = step, .axis = 2}) + kLeastShare)
          << '\n';
  }
  lines << more;
}

CsvTable read_csv(const std::filesystem::path& file) {
  CsvTable table;
  std::ifstream stream(file);
  std::string line;
  const auto cells = [](const std::string& text) {
    std::vector<std::string> out;
    std::istringstream row(text);
    for (std::string cell; std::getline(row, cell, ',');) out.push_back(cell);
    if (text.ends_with(',')) out.emplace_back();
    return out;
  };
  std::getline(stream, line);
  table.names = cells(line);
  while (std::getline(stream, line)) {
    const std::vector<std::string> row = cells(line);
    for (std::size_t i = 0; i < table.names.size(); ++i) table.columns[table.names[i]].push_back(row.at(i));
  }
  return table;
}

std::vector<double> CsvTable::numbers(const std::string& name) const {
  std::vector<double> out;
  for (const std::string& cell : columns.at(name)) out.push_back(std::strtod(cell.c_str(), nullptr));
  return out;
}

}  // namespace astroid::test
