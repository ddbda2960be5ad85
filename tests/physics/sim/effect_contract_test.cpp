// Every effect of every detector keeps the contract; each has one entry here.
#include "astroid/test/effect_contract.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "astroid/sim/effect_table.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 200;
constexpr int kRows = 160;

/// Photon and readout noise, sky, bias and gain; the effect under test comes on top.
Mission quiet() {
  Mission mission = test::bare_mission(kColumns, kRows);
  mission.simulation.exposures = 4;
  mission.field.sky_background = ElectronsPerSecond(20.0);
  mission.ccd.readout_noise = Electrons(12.0);
  mission.ccd.gain = Gain(4.0);
  mission.ccd.bias = Adu(300.0);
  return mission;
}

/// The mission with one thing changed.
test::EffectScene scene(const char* effect, const std::function<void(Mission&)>& on,
                        const std::function<void(Mission&)>& off) {
  Mission mission = quiet();
  if (on) on(mission);
  return {.effect = effect, .mission = mission, .switch_off = off};
}

std::string attitude_file() {
  static const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "attitude.csv").string();
  std::ofstream file(path);
  file << "time_s,yaw,pitch,roll\n";
  for (int i = 0; i < 400; ++i) file << i << ',' << 0.5 * (i % 7) << ',' << 0.3 * (i % 5) << ",0\n";
  return path;
}

std::vector<test::EffectScene> scenes() {
  return {
      scene(
          "jitter-model",
          [](Mission& m) {
            m.satellite.jitter.model = JitterModel::kRedNoise;
            m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.3);
          },
          [](Mission& m) { m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.0); }),
      scene(
          "jitter-file",
          [](Mission& m) {
            m.satellite.jitter.model = JitterModel::kFile;
            m.satellite.jitter.file = attitude_file();
          },
          [](Mission& m) { m.satellite.jitter.model = JitterModel::kNone; }),
      scene(
          "throughput",
          [](Mission& m) {
            m.telescope.throughput.beginning_of_life = 0.9;
            m.telescope.throughput.end_of_life = 0.8;
            m.telescope.throughput.lifetime_years = 0.1;
          },
          [](Mission& m) { m.telescope.throughput = {}; }),
      scene(
          "breathing", [](Mission& m) { m.psf.breathing = {.amplitude = Pixels(0.2), .period = Seconds(300.0)}; },
          [](Mission& m) { m.psf.breathing.amplitude = Pixels(0.0); }),
      scene("stars", {}, {}),
      scene(
          "ghosts",
          [](Mission& m) {
            m.telescope.ghosts = {
                .fraction = 1e-2, .radius = Pixels(12.3), .brighter_than = m.telescope.zero_point - DeltaMag(10.0)};
            m.satellite.jitter = {.model = JitterModel::kRedNoise,
                                  .yaw = Arcseconds(1.0),
                                  .pitch = Arcseconds(1.0),
                                  .roll = Arcseconds(1.0),
                                  .file = {}};
          },
          [](Mission& m) { m.telescope.ghosts.fraction = 0.0; }),
      scene("sky", {}, [](Mission& m) { m.field.sky_background = ElectronsPerSecond(0.0); }),
      scene(
          "vignetting",
          [](Mission& m) {
            m.ccd.pixel_scale = PixelScale(500.0);
            m.telescope.vignetting.model = VignettingModel::kCosineSquared;
          },
          [](Mission& m) { m.telescope.vignetting.model = VignettingModel::kNone; }),
      scene(
          "prnu", [](Mission& m) { m.ccd.prnu = 0.02; }, [](Mission& m) { m.ccd.prnu = 0.0; }),
      scene(
          "dark-current",
          [](Mission& m) {
            m.ccd.dark_current = ElectronsPerSecond(3.0);
            m.ccd.dsnu = 0.15;
          },
          [](Mission& m) { m.ccd.dark_current = ElectronsPerSecond(0.0); }),
      scene("photon-noise", {}, {}),
      scene(
          "full-well",
          [](Mission& m) {
            m.ccd.full_well = Electrons(100000.0);
            m.ccd.blooming = false;
          },
          [](Mission& m) { m.ccd.full_well = Electrons(1e12); }),
      scene("readout-noise", {}, [](Mission& m) { m.ccd.readout_noise = Electrons(0.0); }),
      scene("gain", {}, {}),
      scene("bias", {}, [](Mission& m) { m.ccd.bias = Adu(0.0); }),
      scene("adc", {}, {}),
  };
}

class EffectContract : public testing::TestWithParam<test::EffectScene> {};

TEST_P(EffectContract, IsKept) {
  EXPECT_EFFECT_CONTRACT(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectContract, testing::ValuesIn(scenes()),
                         [](const testing::TestParamInfo<test::EffectScene>& parameter) {
                           std::string name = parameter.param.effect;
                           std::erase(name, '-');
                           return name;
                         });

TEST(EffectContract, CoversEveryEffectOfEveryDetector) {
  std::set<std::string> covered;
  for (const test::EffectScene& s : scenes()) covered.insert(s.effect);
  for (const DetectorType type : {DetectorType::kCcd})
    for (const auto& effect : effect_table(type))
      EXPECT_TRUE(covered.contains(std::string(effect->spec().name))) << effect->spec().name << " has no scene here";
}

}  // namespace
}  // namespace astroid
