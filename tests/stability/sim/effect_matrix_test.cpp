// Random combinations of effects, sizes and scenes: whatever is combined, nothing is NaN, no expectation is negative,
// and what ran is what the plan says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/detector_noise.hpp"
#include "astroid/core/digitise.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/sim/effect_table.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kCombinations = 120;  // of each detector

/// One choice of a combination.
struct Switch {
  const char* name;
  std::function<void(Mission&)> set;
};

/// A path through a file of these lines, the same for every combination.
std::string file_of(const char* name, const std::string& lines) {
  static const test::TemporaryFolder folder;
  return folder.write(name, lines).string();
}

std::string attitude_file() {
  std::string lines = "time_s,yaw,pitch,roll\n";
  for (int i = 0; i < 400; ++i)
    lines += std::to_string(i) + ',' + std::to_string(0.5 * (i % 7)) + ',' + std::to_string(0.3 * (i % 5)) + ",20\n";
  lines += "1e9,3,1,20\n";  // for the longest of runs
  return file_of("attitude.csv", lines);
}

std::string spectrum_file() {
  return file_of("spectrum.csv", "frequency_hz,yaw,pitch,roll\n1e-5,100,100,0\n1e-3,10,0,10\n0.1,0.01,0.02,0.1\n");
}

std::string variables_file() {
  return file_of("variables.csv",
                 "id,kind,amplitude_ppm,period_d,depth_ppm,duration_h,epoch_d\n"
                 "star1,sinusoid,400000,0.001,,,\nstar1,transit,,0.002,500000,0.02,0.0005\n");
}

std::vector<Switch> switches_of_both() {
  return {
      {"sky", [](Mission& m) { m.field.sky_background = ElectronsPerSecond(45.0); }},
      {"dark", [](Mission& m) { m.ccd.dark_current = ElectronsPerSecond(1.2); }},
      {"DSNU", [](Mission& m) { m.ccd.dsnu = 0.6; }},
      {"PRNU", [](Mission& m) { m.ccd.prnu = 0.3; }},
      {"readout noise", [](Mission& m) { m.ccd.readout_noise = Electrons(50.2); }},
      {"gain", [](Mission& m) { m.ccd.gain = Gain(25.0); }},
      {"bias", [](Mission& m) { m.ccd.bias = Adu(1000.0); }},
      {"few bits", [](Mission& m) { m.ccd.adc_bits = 12; }},
      {"full well", [](Mission& m) { m.ccd.full_well = Electrons(90000.0); }},
      {"non-linearity",
       [](Mission& m) {
         m.ccd.electronics.nonlinearity = {0.3, -0.0043, 2.4e-7};
       }},
      {"drifts",
       [](Mission& m) {
         m.ccd.electronics.gain_drift = 0.01;
         m.ccd.electronics.bias_drift = 20.0;
         m.ccd.electronics.drift_period = Seconds(60.0);
       }},
      {"row offsets", [](Mission& m) { m.ccd.electronics.row_offset = 3.0; }},
      {"pick-up noise",
       [](Mission& m) {
         m.ccd.electronics.pick_up = {.amplitude = 40.0, .column_frequency = 0.37, .row_frequency = -0.11};
       }},
      {"bad pixels", [](Mission& m) { m.ccd.bad_pixels = {.dead = 0.05, .hot = 0.05}; }},
      {"jitter",
       [](Mission& m) {
         m.satellite.jitter.model = JitterModel::kRedNoise;
         m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(0.04);
       }},
      {"strong jitter",
       [](Mission& m) {
         m.satellite.jitter.model = JitterModel::kRedNoise;
         m.satellite.jitter.yaw = m.satellite.jitter.roll = Arcseconds(6.0);
         m.satellite.jitter.timescale = Seconds(3.0);
       }},
      {"attitude file",
       [](Mission& m) {
         m.satellite.jitter = {
             .model = JitterModel::kFile, .yaw = {}, .pitch = {}, .roll = {}, .file = attitude_file()};
       }},
      {"spectrum of jitter",
       [](Mission& m) {
         m.satellite.jitter = {
             .model = JitterModel::kSpectrum, .yaw = {}, .pitch = {}, .roll = {}, .file = spectrum_file()};
       }},
      {"variable star", [](Mission& m) { m.field.variables = variables_file(); }},
      {"throughput",
       [](Mission& m) {
         m.telescope.throughput = {
             .beginning_of_life = 0.7, .end_of_life = 0.1, .lifetime_years = 0.1, .age_years = 0.05};
       }},
      {"breathing", [](Mission& m) { m.psf.breathing = {.amplitude = Pixels(0.4), .period = Seconds(77.0)}; }},
      {"vignetting",
       [](Mission& m) {
         m.ccd.pixel_scale = PixelScale(3000.0);
         m.telescope.vignetting.model = VignettingModel::kCosineSquared;
       }},
      {"distortion",
       [](Mission& m) {
         m.telescope.distortion.model = DistortionModel::kRadial;
         m.telescope.distortion.radial = {0.3, 0.02, 0.4};
         m.telescope.distortion.tangential = {5e-4, 2e-4};
       }},
      {"ghosts",
       [](Mission& m) {
         m.telescope.ghosts = {.fraction = 0.01, .radius = Pixels(7.3), .brighter_than = Magnitude(12.0)};
       }},
      {"charge diffusion", [](Mission& m) { m.psf.diffusion = Pixels(0.3); }},
      {"drift", [](Mission& m) { m.satellite.drift.yaw_rate = Arcseconds(4000.0); }},
      {"re-pointing",
       [](Mission& m) {
         m.satellite.quarter_days = 30.0 / 86400.0;
         m.satellite.repointing.pitch = m.satellite.repointing.roll = Arcseconds(9.0);
         m.satellite.drift.roll = Arcseconds(60.0);
       }},
      {"aberration",
       [](Mission& m) {
         m.simulation.cycle = Seconds(0.1 * kSecondsPerDay);
         m.ccd.axis_x = 1500.0;
         m.satellite.aberration = true;
       }},
      {"zodiacal sky", [](Mission& m) { m.field.sky = SkyModel::kZodiacal; }},
      {"stray light",
       [](Mission& m) {
         m.field.stray_light = {.level = ElectronsPerSecond(64.0), .gradient_x = 0.5, .gradient_y = -0.5};
       }},
      {"flat field", [](Mission& m) { m.ccd.flat_field = {.rms = 0.4, .exponent = 2.0}; }},
      {"cosmic rays", [](Mission& m) { m.ccd.cosmic_rays.rate = 3000.0; }},
      {"narrow PSF", [](Mission& m) { m.psf.sigma = Pixels(0.05); }},
      {"wide PSF", [](Mission& m) { m.psf.sigma = Pixels(4.5); }},
      {"rough", [](Mission& m) { m.simulation.accuracy = Ppm(10000.0); }},
      {"exact", [](Mission& m) { m.simulation.accuracy = Ppm(0.01); }},
      {"windows", [](Mission& m) { m.ccd.window = 7; }},
      {"sub-field",
       [](Mission& m) {
         m.ccd.has_sub_field = true;
         m.ccd.sub_x0 = m.ccd.columns / 4;
         m.ccd.sub_y0 = m.ccd.rows / 3;
         m.ccd.sub_columns = std::max(1, m.ccd.columns / 2);
         m.ccd.sub_rows = std::max(1, m.ccd.rows / 2);
       }},
      {"next quarter",
       [](Mission& m) {
         m.simulation.quarter = 3;
         m.satellite.quarter_days = 0.4;
         m.satellite.repointing = {.yaw = Arcseconds(9.0), .pitch = {}, .roll = {}, .turn = Degrees(90.0)};
       }},
      {"sub-pixel renderer", [](Mission& m) { m.simulation.renderer = Renderer::kSubPixel; }},
      {"intra-pixel response",
       [](Mission& m) {
         m.psf.intra_pixel.depth = 0.2;
         m.simulation.accuracy = Ppm(1000.0);  // libraries for stars of 1 beside 1e8 e- take long to make
       }},
  };
}

std::vector<Switch> switches_of_ccd() {
  return {
      {"no blooming", [](Mission& m) { m.ccd.blooming = false; }},
      {"reference pixels",
       [](Mission& m) { m.ccd.reference = {.prescan = 4, .serial_overscan = 3, .parallel_overscan = 5}; }},
      {"open shutter", [](Mission& m) { m.ccd.smearing.model = SmearingModel::kOpenShutter; }},
      {"frame transfer",
       [](Mission& m) {
         m.ccd.smearing.model = SmearingModel::kFrameTransfer;
         m.ccd.smearing.clear_time = Seconds(0.0);
       }},
      {"two nodes",
       [](Mission& m) {
         m.ccd.nodes = {.count = 2, .gain_factor = {1.0, 1.15}, .noise_factor = {1.0, 0.0}, .cross_talk = 1e-3};
       }},
      {"four nodes",
       [](Mission& m) {
         m.ccd.nodes = {.count = 4, .gain_factor = {}, .noise_factor = {2.0, 1.0, 1.0, 1.0}, .cross_talk = -1e-2};
       }},
      {"charge injection",
       [](Mission& m) { m.ccd.charge_injection = {.every_rows = 7, .first_row = 3, .level = Electrons(3e4)}; }},
      {"cosmic rays through a slab",
       [](Mission& m) {
         m.ccd.cosmic_rays.rate = 1000.0;
         m.ccd.cosmic_rays.model = CosmicRayKind::kSlab;
         m.ccd.cosmic_rays.longest_track = Pixels(60.0);
       }},
      {"brighter-fatter",
       [](Mission& m) { m.ccd.brighter_fatter = {.serial = 3e-7, .parallel = 5e-7, .decay = 0.5, .range = 3}; }},
      {"overscan", [](Mission& m) { m.ccd.reference = {.prescan = 2, .serial_overscan = 3, .parallel_overscan = 4}; }},
      {"simple CTI",
       [](Mission& m) {
         m.ccd.cti.model = CtiModel::kSimple;
         m.ccd.cti.parallel = 1e-3;
         m.ccd.cti.serial = 1e-4;
       }},
      {"traps",
       [](Mission& m) {
         m.ccd.cti.model = CtiModel::kTraps;
         m.ccd.cti.trap_density = {4.9, 6.62};
         m.ccd.cti.register_density = {0.5, 0.0};
         m.ccd.cti.trap_cross_section = {2.46e-20, 2.45e-23};
         m.ccd.cti.trap_release_time = {2.37e-4, 0.14};
       }},
  };
}

std::vector<Switch> switches_of_cmos() {
  return {
      {"ramp", [](Mission& m) { m.cmos.reads = 4; }},
      {"two reads",
       [](Mission& m) {
         m.cmos.reads = 2;
         m.cmos.ramp_fit = RampFit::kLeastSquares;
       }},
      {"coupled pixels", [](Mission& m) { m.cmos.coupling = m.cmos.corner_coupling = 0.02; }},
      {"reset noise", [](Mission& m) { m.cmos.reset_noise = Electrons(40.0); }},
      {"rows and columns", [](Mission& m) { m.cmos.column_noise = m.cmos.row_noise = Electrons(5.0); }},
      {"uneven offset", [](Mission& m) { m.cmos.offset_rms = Adu(30.0); }},
      {"uneven gain", [](Mission& m) { m.cmos.gain_rms = 0.2; }},
      {"telegraph",
       [](Mission& m) {
         m.cmos.telegraph_fraction = 0.3;
         m.cmos.telegraph_current = ElectronsPerSecond(50.0);
       }},
      {"persistence",
       [](Mission& m) {
         m.cmos.persistence = {.fraction = {0.1, 0.05}, .time = {3.0, 1e4}};
       }},
      {"rolling shutter", [](Mission& m) { m.cmos.line_time = Seconds(0.1); }},
  };
}

struct Combination {
  Mission mission;
  std::vector<test::LabStar> stars;
  bool on_the_sky = false;  ///< whether the catalogue gives directions and proper motions instead of pixels
  std::string name;
};

/// The catalogue of a combination. On the sky, the stars are where they are asked for at the catalogue's epoch.
StarCatalogue catalogue(const Combination& c) {
  StarCatalogue stars = test::lab_catalogue(c.stars);
  if (!c.on_the_sky) return stars;
  const Scene in_pixels(c.mission, stars);
  stars.positions = PositionKind::kSky;
  double sign = 1.0;
  for (CatalogueStar& star : stars.stars) {
    star.sky = in_pixels.projection()->to_sky(star.pixel);
    star.pm_ra = 1400.0 * sign;
    star.pm_dec = -700.0;
    sign = -sign;
  }
  stars.stars.back().pm_ra = stars.stars.back().pm_dec = 0.0;  // the one of every window
  return stars;
}

Combination combination(DetectorType type, std::uint32_t number) {
  const RandomStream stream = make_stream(1, StreamId{number}, 0, 0);
  std::uint64_t drawn = 0;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * uniform_at_step(stream, {.step = drawn++});
  };
  const auto side = [&] { return static_cast<int>(std::exp(uniform(0.0, std::log(90.0)))); };
  Combination c{.mission = test::bare_mission(side() + 8, side() + 8), .stars = {}, .on_the_sky = false, .name = {}};
  c.mission.simulation.seed = number;
  c.mission.simulation.type = type;
  std::vector<Switch> switches = switches_of_both();
  std::ranges::copy(type == DetectorType::kCcd ? switches_of_ccd() : switches_of_cmos(), std::back_inserter(switches));
  for (const Switch& s : switches)
    if (uniform(0.0, 1.0) < 0.35) {
      s.set(c.mission);
      c.name += std::string(c.name.empty() ? "" : ", ") + s.name;
    }
  c.on_the_sky = uniform(0.0, 1.0) < 0.35;
  if (c.on_the_sky) c.name += ", on the sky";
  const auto count = static_cast<int>(std::exp(uniform(0.0, std::log(60.0))));
  for (int i = 0; i < count; ++i)
    c.stars.push_back({uniform(-3.0, c.mission.ccd.columns + 3.0), uniform(-3.0, c.mission.ccd.rows + 3.0),
                       std::pow(10.0, uniform(0.0, 8.0))});
  // One star that every sub-field and window has.
  c.stars.push_back({0.5 * c.mission.ccd.columns, 0.5 * c.mission.ccd.rows, 1e5});
  return c;
}

class EffectMatrix : public testing::TestWithParam<DetectorType> {};

TEST_P(EffectMatrix, HasNoCombinationThatGoesWrong) {
  std::set<std::string> ever;
  int exposures = 0;
  for (std::uint32_t number = 0; number < kCombinations; ++number) {
    const Combination c = combination(GetParam(), number);
    SCOPED_TRACE("combination " + std::to_string(number) + ": " + c.name);
    std::shared_ptr<const Scene> scene;
    ASSERT_NO_THROW(scene = std::make_shared<const Scene>(c.mission, catalogue(c)));
    const auto plan = std::make_shared<const Plan>(make_plan(*scene));
    const Simulator simulator(scene, plan, 0);
    ExposureState state = simulator.make_state();
    simulator.expect(1, state);
    for (const double value : std::as_const(state.expected).whole().pixels())
      ASSERT_TRUE(value >= 0.0 && std::isfinite(value)) << value;
    std::set<std::string> ran;
    ExposureState seen = simulator.make_state();
    simulator.simulate(1, seen, [&](const EffectSpec& effect, const ExposureState& s) {
      ran.emplace(effect.name);
      if (effect.level != EffectLevel::kPixelSample) return;
      const auto bad = [](double value) { return !std::isfinite(value); };
      EXPECT_FALSE(std::ranges::any_of(s.sampled.whole().pixels(), bad)) << effect.name;
    });
    for (const PlannedEffect& planned : plan->effects) {
      const std::string name(planned.effect->spec().name);
      ASSERT_EQ(ran.contains(name), planned.need.needed) << name;
      ASSERT_FALSE(planned.need.why.empty()) << name;
      ASSERT_TRUE(planned.need.bias_bound >= 0.0 && planned.need.variance_bound >= 0.0) << name;
      if (planned.need.needed) ever.insert(name);
    }
    ExposureState state2 = simulator.make_state();
    simulator.simulate(1, state2);
    const double top = adc_top(delivered_bits(c.mission));
    const auto pixels = std::as_const(state2.frame.pixels).pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_TRUE(pixels[i] >= 0.0F && static_cast<double>(pixels[i]) <= top) << pixels[i];
      ASSERT_EQ(pixels[i], std::as_const(seen.frame.pixels).pixels()[i]) << "looking changes pixel " << i;
    }
    ++exposures;
  }
  EXPECT_EQ(exposures, kCombinations);
  std::printf("%d combinations, %zu effects ran in some of them\n", exposures, ever.size());
  for (const auto& effect : effect_table(GetParam()))
    EXPECT_TRUE(ever.contains(std::string(effect->spec().name))) << effect->spec().name << " ran in no combination";
}

INSTANTIATE_TEST_SUITE_P(Detectors, EffectMatrix, testing::Values(DetectorType::kCcd, DetectorType::kCmos),
                         [](const auto& tested) { return tested.param == DetectorType::kCcd ? "Ccd" : "Cmos"; });

}  // namespace
}  // namespace astroid
