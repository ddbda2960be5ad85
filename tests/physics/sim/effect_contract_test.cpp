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

/// The same of a CMOS detector that is read five times in an exposure.
test::EffectScene cmos_scene(const char* effect, const std::function<void(Mission&)>& on,
                             const std::function<void(Mission&)>& off) {
  Mission mission = quiet();
  mission.simulation.type = DetectorType::kCmos;
  mission.cmos.reads = 5;
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

std::string variables_file() {
  static const test::TemporaryFolder folder;
  return folder
      .write("variables.csv",
             "id,kind,amplitude_ppm,period_d,depth_ppm,duration_h,epoch_d\n"
             "star1,sinusoid,200000,0.001,,,\nstar5,transit,,0.002,500000,0.02,0.0005\n")
      .string();
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
      scene("sub-pixel-stars", [](Mission& m) { m.simulation.renderer = Renderer::kSubPixel; }, {}),
      scene(
          "intra-pixel-response", [](Mission& m) { m.psf.intra_pixel.depth = 0.05; },
          [](Mission& m) { m.psf.intra_pixel.depth = 0.0; }),
      scene(
          "drift",
          [](Mission& m) {
            m.satellite.drift.yaw_rate = Arcseconds(3000.0);
            m.satellite.drift.roll = Arcseconds(3000.0);
          },
          [](Mission& m) { m.satellite.drift = {}; }),
      scene(
          "re-pointing",
          [](Mission& m) {
            m.satellite.quarter_days = 20.0 / 86400.0;
            m.satellite.repointing.yaw = m.satellite.repointing.roll = Arcseconds(2.0);
          },
          [](Mission& m) { m.satellite.repointing = {}; }),
      scene(
          "aberration",
          [](Mission& m) {
            m.simulation.cycle = Seconds(40.0 * 86400.0);
            m.ccd.axis_x = 1500.0;
            m.satellite.aberration = true;
          },
          [](Mission& m) { m.satellite.aberration = false; }),
      scene("stars", {}, {}),
      scene(
          "variable-stars", [](Mission& m) { m.field.variables = variables_file(); },
          [](Mission& m) { m.field.variables.clear(); }),
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
      scene("zodiacal-sky", [](Mission& m) { m.field.sky = SkyModel::kZodiacal; }, {}),
      scene(
          "stray-light",
          [](Mission& m) {
            m.field.stray_light.level = ElectronsPerSecond(30.0);
            m.field.stray_light.gradient_x = 0.3;
            m.field.stray_light.gradient_y = -0.2;
          },
          [](Mission& m) { m.field.stray_light = {}; }),
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
      scene(
          "flat-field", [](Mission& m) { m.ccd.flat_field.rms = 0.01; },
          [](Mission& m) { m.ccd.flat_field.rms = 0.0; }),
      scene(
          "charge-injection",
          [](Mission& m) { m.ccd.charge_injection = {.every_rows = 9, .first_row = 3, .level = Electrons(5e3)}; },
          [](Mission& m) { m.ccd.charge_injection.every_rows = 0; }),
      scene(
          "dead-pixels", [](Mission& m) { m.ccd.bad_pixels.dead = 0.01; },
          [](Mission& m) { m.ccd.bad_pixels.dead = 0.0; }),
      scene(
          "hot-pixels", [](Mission& m) { m.ccd.bad_pixels.hot = 0.01; },
          [](Mission& m) { m.ccd.bad_pixels.hot = 0.0; }),
      scene(
          "bad-pixel-map", [](Mission& m) { m.ccd.bad_pixels.dead = m.ccd.bad_pixels.hot = 0.02; },
          [](Mission& m) { m.ccd.bad_pixels.dead = m.ccd.bad_pixels.hot = 0.0; }),
      scene(
          "open-shutter-smearing",
          [](Mission& m) {
            m.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(4.0)};
            m.ccd.reference = {.prescan = 10, .serial_overscan = 5, .parallel_overscan = 20};
            m.satellite.jitter.model = JitterModel::kRedNoise;
            m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.1);
          },
          [](Mission& m) { m.ccd.smearing.model = SmearingModel::kNone; }),
      scene(
          "open-shutter-smearing",
          [](Mission& m) {
            m.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(4.0)};
            m.ccd.reference = {.prescan = 10, .serial_overscan = 5, .parallel_overscan = 20};
            m.ccd.nodes.count = 4;
          },
          [](Mission& m) { m.ccd.smearing.model = SmearingModel::kNone; }),
      scene(
          "frame-transfer-smearing",
          [](Mission& m) {
            m.ccd.smearing = {.model = SmearingModel::kFrameTransfer, .time = Seconds(4.0), .clear_time = Seconds(1.0)};
            m.ccd.reference.parallel_overscan = 20;
          },
          [](Mission& m) { m.ccd.smearing.model = SmearingModel::kNone; }),
      scene("photon-noise", {}, {}),
      scene(
          "cosmic-rays", [](Mission& m) { m.ccd.cosmic_rays.rate = 500.0; },
          [](Mission& m) { m.ccd.cosmic_rays.rate = 0.0; }),
      scene(
          "brighter-fatter",
          [](Mission& m) { m.ccd.brighter_fatter = {.serial = 3e-7, .parallel = 4e-7, .decay = 0.5, .range = 4}; },
          [](Mission& m) { m.ccd.brighter_fatter = {}; }),
      scene(
          "cti",
          [](Mission& m) {
            m.ccd.cti.model = CtiModel::kSimple;
            m.ccd.cti.parallel = m.ccd.cti.serial = 1e-4;
          },
          [](Mission& m) { m.ccd.cti.parallel = m.ccd.cti.serial = 0.0; }),
      scene(
          "full-well", [](Mission& m) { m.ccd.full_well = Electrons(60000.0); },
          [](Mission& m) { m.ccd.full_well = Electrons(1e12); }),
      scene("readout-noise", {}, [](Mission& m) { m.ccd.readout_noise = Electrons(0.0); }),
      scene("gain", {}, {}),
      scene("bias", {}, [](Mission& m) { m.ccd.bias = Adu(0.0); }),
      scene(
          "cross-talk",
          [](Mission& m) {
            m.ccd.nodes.count = 4;
            m.ccd.nodes.cross_talk = 0.01;
            m.ccd.reference = {.prescan = 4, .serial_overscan = 4, .parallel_overscan = 6};
          },
          [](Mission& m) { m.ccd.nodes.cross_talk = 0.0; }),
      scene(
          "non-linearity",
          [](Mission& m) {
            m.ccd.electronics.nonlinearity = {0.0, -0.0042789409, 2.365e-7};
          },
          [](Mission& m) { m.ccd.electronics.nonlinearity.clear(); }),
      scene(
          "bias-drift", [](Mission& m) { m.ccd.electronics.bias_drift = 30000.0; },
          [](Mission& m) { m.ccd.electronics.bias_drift = 0.0; }),
      scene(
          "row-offset",
          [](Mission& m) {
            m.ccd.electronics.row_offset = 2.0;
            m.ccd.nodes.count = 2;
          },
          [](Mission& m) { m.ccd.electronics.row_offset = 0.0; }),
      scene(
          "pick-up-noise",
          [](Mission& m) {
            m.ccd.electronics.pick_up = {.amplitude = 5.0, .column_frequency = 0.21, .row_frequency = -0.03};
            m.ccd.reference = {.prescan = 4, .serial_overscan = 4, .parallel_overscan = 6};
          },
          [](Mission& m) { m.ccd.electronics.pick_up.amplitude = 0.0; }),
      scene("adc", {}, {}),
      cmos_scene(
          "telegraph-pixels",
          [](Mission& m) {
            m.cmos.telegraph_fraction = 0.02;
            m.cmos.telegraph_current = ElectronsPerSecond(40.0);
            m.cmos.telegraph_low = m.cmos.telegraph_high = Seconds(80.0);
          },
          [](Mission& m) { m.cmos.telegraph_fraction = 0.0; }),
      cmos_scene(
          "persistence",
          [](Mission& m) {
            m.cmos.persistence = {.fraction = {0.01, 0.005}, .time = {40.0, 300.0}};
            m.satellite.jitter.model = JitterModel::kRedNoise;
            m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.3);
          },
          [](Mission& m) { m.cmos.persistence = {}; }),
      cmos_scene(
          "rolling-shutter",
          [](Mission& m) {
            m.cmos.line_time = Seconds(0.1);
            m.satellite.jitter.model = JitterModel::kRedNoise;
            m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.9);
            m.satellite.jitter.timescale = Seconds(30.0);
          },
          [](Mission& m) { m.cmos.line_time = Seconds(0.0); }),
      cmos_scene(
          "pixel-saturation", [](Mission& m) { m.ccd.full_well = Electrons(100000.0); },
          [](Mission& m) { m.ccd.full_well = Electrons(1e12); }),
      cmos_scene(
          "inter-pixel-capacitance",
          [](Mission& m) {
            m.cmos.coupling = 0.01;
            m.cmos.corner_coupling = 0.001;
          },
          [](Mission& m) { m.cmos.coupling = m.cmos.corner_coupling = 0.0; }),
      cmos_scene(
          "pixel-gain", [](Mission& m) { m.cmos.gain_rms = 0.01; }, [](Mission& m) { m.cmos.gain_rms = 0.0; }),
      cmos_scene(
          "reset-noise",
          [](Mission& m) {
            m.cmos.reads = 1;
            m.cmos.reset_noise = Electrons(40.0);
          },
          [](Mission& m) { m.cmos.reset_noise = Electrons(0.0); }),
      cmos_scene(
          "column-noise", [](Mission& m) { m.cmos.column_noise = m.cmos.row_noise = Electrons(9.0); },
          [](Mission& m) { m.cmos.column_noise = m.cmos.row_noise = Electrons(0.0); }),
      cmos_scene(
          "pixel-offset",
          [](Mission& m) {
            m.cmos.reads = 1;
            m.cmos.offset_rms = Adu(9.0);
          },
          [](Mission& m) { m.cmos.offset_rms = Adu(0.0); }),
      cmos_scene("ramp-reads", {}, [](Mission& m) { m.cmos.reads = 1; }),
      cmos_scene("ramp-fit", {}, [](Mission& m) { m.cmos.reads = 1; }),
      // What both kinds have, read several times.
      cmos_scene("photon-noise", {}, {}),
      cmos_scene(
          "readout-noise", [](Mission& m) { m.cmos.noise_rms = 0.3; },
          [](Mission& m) { m.ccd.readout_noise = Electrons(0.0); }),
      cmos_scene("adc", {}, {}),
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
                           if (parameter.param.mission.simulation.type == DetectorType::kCmos) name += "OfCmos";
                           if (parameter.param.mission.ccd.nodes.count > 1)
                             name += "Of" + std::to_string(parameter.param.mission.ccd.nodes.count) + "Nodes";
                           return name;
                         });

TEST(EffectContract, CoversEveryEffectOfEveryDetector) {
  std::set<std::string> covered;
  for (const test::EffectScene& s : scenes()) covered.insert(s.effect);
  covered.insert("proper-motion");  // touches no plane: its work is done when the scene is built
  for (const DetectorType type : {DetectorType::kCcd, DetectorType::kCmos})
    for (const auto& effect : effect_table(type))
      EXPECT_TRUE(covered.contains(std::string(effect->spec().name))) << effect->spec().name << " has no scene here";
}

}  // namespace
}  // namespace astroid
