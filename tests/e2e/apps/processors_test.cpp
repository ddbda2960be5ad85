// The same configuration gives the same bits whatever vector instructions the processor has, from the random words to
// the light curves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <utility>

#include "astroid/core/fits_writer.hpp"
#include "astroid/core/vector_target.hpp"
#include "astroid/test/psf_table.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

/// Writes psf.fits: a Gaussian of 0.7 px on samples of 1/8 px.
void write_psf(const std::filesystem::path& folder) {
  constexpr int kSamplesPerPixel = 8;
  const PsfTable table = test::gaussian_psf_table(0.7, kSamplesPerPixel, 5.0);
  FitsWriter fits(folder / "psf.fits");
  fits.begin_image(FitsNumber::kFloat64, {table.samples.nx(), table.samples.ny()});
  fits.card({"SUBPIX", kSamplesPerPixel});
  fits.write_pixels(0, table.samples.pixels());
  fits.commit();
}

using Words = std::vector<std::string>;

Words joined(std::initializer_list<Words> parts) {
  Words all;
  for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Parameters as arguments of the command line.
Words set(const Words& parameters) {
  Words arguments;
  for (const std::string& parameter : parameters) arguments.insert(arguments.end(), {"--set", parameter});
  return arguments;
}

/// Every effect, with stars that bloom and pixels that the ADC clips; images and light curves of everything, and the
/// maps after each step of an exposure: their last bits are not yet rounded to ADU.
const Words kEveryEffect = {"CCD/FullWell=200000",    "CCD/ADCBits=13",         "Output/Images=all",
                            "Output/Lightcurves=all", "Simulation/Exposures=3", "Output/DumpSteps=1"};
const std::set<std::string> kEffects = {"jitter-model", "stars",     "sky",           "prnu", "dark-current", "gain",
                                        "photon-noise", "full-well", "readout-noise", "bias", "adc"};

/// What pointing, optics, sky, pixels and electronics of both kinds of detector add to these.
const Words kOptics = {"StellarField/Catalogue=field.csv",
                       "StellarField/Variables=variables.csv",
                       "Satellite/Drift/YawRate=900",
                       "Satellite/Drift/Roll=2",
                       "Satellite/Quarter=40 s",
                       "Satellite/Repointing/Pitch=0.5",
                       "Telescope/Throughput=0.9",
                       "Telescope/Ageing/EndOfLife=0.8",
                       "Telescope/Vignetting/model=cos2",
                       "Telescope/Ghosts/Fraction=0.001",
                       "Telescope/Ghosts/BrighterThan=12",
                       "PSF/Breathing/Amplitude=0.1",
                       "PSF/Breathing/Period=200",
                       "PSF/ChargeDiffusion=0.2",
                       "StellarField/StrayLight/Level=3",
                       "StellarField/StrayLight/GradientX=0.3",
                       "CCD/FlatField/RMS=1",
                       "CCD/CosmicRays/Rate=100",
                       "CCD/BadPixels/Dead=0.5",
                       "CCD/BadPixels/Hot=0.5"};
const Words kCcd = {"CCD/OpticalAxis/X=3000",  // far away, so that aberration moves stars
                    "Satellite/Aberration=on",
                    "CCD/ChargeInjection/EveryRows=40",
                    "CCD/ChargeInjection/Level=5000",
                    "CCD/BrighterFatter/Serial=3e-7",
                    "CCD/BrighterFatter/Parallel=4e-7",
                    "CCD/CTI/model=simple",
                    "CCD/CTI/Parallel=1e-5",
                    "CCD/CTI/Serial=1e-5",
                    "CCD/ReferencePixels/Prescan=8",
                    "CCD/ReferencePixels/SerialOverscan=8",
                    "CCD/ReferencePixels/Overscan=10",
                    "CCD/Smearing/model=open-shutter",
                    "CCD/Nodes/Count=2",
                    "CCD/Nodes/GainFactors=1.02 0.97",
                    "CCD/Nodes/CrossTalk=0.001",
                    "CCD/Electronics/NonLinearity=0 -0.0042789409 2.365e-7",
                    "CCD/Electronics/BiasDrift=3",
                    "CCD/Electronics/RowOffset=1",
                    "Photometry/Calibration/Smearing=on",
                    "Photometry/Calibration/Bias=prescan"};
const Words kOtherCcd = {"StellarField/SkyModel=zodiacal",
                         "CCD/CosmicRays/model=slab",
                         "CCD/CTI/model=traps",
                         "CCD/CTI/TrapDensity=4.9 6.62",
                         "CCD/CTI/RegisterDensity=0.5 0",
                         "CCD/CTI/CrossSection=2.46e-20 2.45e-23",
                         "CCD/CTI/ReleaseTime=2.37e-4 0.14",
                         "CCD/ReferencePixels/Overscan=10",
                         "CCD/Smearing/model=frame-transfer",
                         "CCD/Electronics/GainDrift=0.1",
                         "CCD/Electronics/PickUpAmplitude=3",
                         "CCD/Electronics/PickUpColumnFrequency=0.37",
                         "Simulation/Quarter=1",
                         "Photometry/Method=weighted"};
const Words kCmos = {"Simulation/Type=CMOS",
                     "CMOS/Reads=4",
                     "CMOS/ResetNoise=20",
                     "CMOS/ColumnNoise=3",
                     "CMOS/RowNoise=3",
                     "CMOS/GainSpread=1",
                     "CMOS/ReadoutNoiseSpread=0.2",
                     "CMOS/Coupling/Side=1",
                     "CMOS/Telegraph/Fraction=1",
                     "CMOS/Telegraph/Current=5",
                     "CMOS/OffsetSpread=4",
                     "CMOS/LineTime=0.1",
                     "CMOS/Persistence/Fraction=0.3 0.1",
                     "CMOS/Persistence/Time=60 900"};

constexpr std::size_t kImages = 3;
const std::size_t kMaps = kEffects.size() - 1;  // jitter has none

/// A scene of small.xml with some parameters changed, and how its plan must render the stars.
struct Case {
  std::string name;
  std::string method;  ///< of photometry
  Words parameters;
  std::string renderer;
  std::string jitter;

  friend void PrintTo(const Case& scene, std::ostream* out) { *out << scene.name << ", " << scene.method; }
};

std::vector<Case> cases() {
  const Words crowd = {"StellarField/Catalogue=crowd.csv", "CCD/Columns=64", "CCD/Rows=64"};
  const Words table = {"PSF/Model=table", "PSF/File=psf.fits", "StellarField/Catalogue=field.csv", "CCD/Columns=75",
                       "CCD/Rows=61"};
  const Words two = {"Telescope/SimulatedCameras=2"};
  const Words moves = {"Satellite/Jitter/Yaw=0.3"};
  const std::string polynomial = "polynomial in the attitude";
  const std::string broadened = "shift and broadening";
  return {{"Sparse", "mask", two, "analytic", "shift"},
          {"Moving", "weighted", moves, "analytic", broadened},
          {"Crowded", "mask", crowd, "analytic", polynomial},
          {"Crowded", "weighted", crowd, "analytic", polynomial},
          {"Crowded", "psf", joined({crowd, two}), "analytic", polynomial},
          {"Tabulated", "mask", table, "prf", polynomial},
          {"TabulatedMoving", "psf", joined({table, moves, two}), "prf", broadened}};
}

/// Drawings are not compared, and take longer than all the rest.
const std::string kNoGnuplot = "PATH=/";

class Processors : public testing::Test {
 protected:
  void SetUp() override {
    test::write_small_mission(folder_);
    const std::string bright = "bright,24,36,2e6\n";
    test::write_pixel_field(folder_.path() / "field.csv", 60, 40, bright);
    constexpr int kCrowd = 580;  // 14 stars in 100 px
    test::write_pixel_field(folder_.path() / "crowd.csv", 64, kCrowd, bright);
    write_psf(folder_.path());
    folder_.write("variables.csv",
                  "id,kind,amplitude_ppm,period_d,depth_ppm,duration_h,epoch_d\n"
                  "bright,sinusoid,5000,0.002,,,\nbright,transit,,0.003,10000,0.02,0.0005\n");
  }
  std::filesystem::path run(const std::string& name, const Words& runner, const Words& arguments) {
    const test::ProgramResult result =
        test::run_astroid_through(runner, joined({{"assess", "small.xml", "-o", name}, arguments}), folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return folder_.path() / name;
  }
  test::TemporaryFolder folder_;
};

void expect_plan(const std::filesystem::path& folder, const Case& scene) {
  const auto plan = nlohmann::json::parse(test::read_file(folder / "plan.json"));
  EXPECT_EQ(plan.at("renderer"), scene.renderer);
  EXPECT_EQ(plan.at("jitter").at("treatment"), scene.jitter);
  std::set<std::string> on;
  for (const auto& effect : plan.at("effects"))
    if (effect.at("on")) on.insert(effect.at("name").get<std::string>());
  EXPECT_EQ(on, kEffects);
}

/// How many sources have a flag of measurement_flag.
std::ptrdiff_t flagged(const std::filesystem::path& folder, int flag) {
  const auto flags = test::read_csv(folder / "photometry/sources.csv").numbers("flags");
  return std::ranges::count_if(flags, [flag](double f) { return (static_cast<int>(f) & flag) != 0; });
}

class SameForAnySimdTarget : public Processors, public testing::WithParamInterface<Case> {};

INSTANTIATE_TEST_SUITE_P(Bits, SameForAnySimdTarget, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name + "_" + test.param.method; });

TEST_P(SameForAnySimdTarget, AreAllProducts) {
  const Case& scene = GetParam();
  std::filesystem::path first;
  int threads = 0;
  for (const std::string& target : vector_targets()) {
    const auto folder = run(target, {"env", "ASTROID_VECTORS=" + target, kNoGnuplot},
                            joined({set(kEveryEffect),
                                    set(scene.parameters),
                                    {"--set", "Photometry/Method=" + scene.method},
                                    {"--threads", std::to_string(1 + threads++ % 3)}}));
    if (first.empty()) {
      first = folder;
      expect_plan(first, scene);
      constexpr int kSaturated = 2;
      EXPECT_GT(flagged(first, kSaturated), 0);
    } else {
      EXPECT_GE(test::expect_same_products(first, folder), kImages + kMaps + 10U);
    }
  }
}

TEST_F(Processors, AWholeInstrumentHasTheSameBitsOnAnyVectorsAndThreads) {
  std::set<std::string> ever;
  std::set<std::string> never;
  for (const auto& [name, detector] :
       {std::pair{"ccd", kCcd}, std::pair{"other", kOtherCcd}, std::pair{"cmos", kCmos}}) {
    std::filesystem::path first;
    int threads = 0;
    for (const std::string& target : vector_targets()) {
      const auto folder = run(
          name + target, {"env", "ASTROID_VECTORS=" + target, kNoGnuplot},
          joined({set(kEveryEffect), set(kOptics), set(detector), {"--threads", std::to_string(1 + threads++ % 3)}}));
      if (first.empty()) {
        first = folder;
        const auto plan = nlohmann::json::parse(test::read_file(folder / "plan.json"));
        for (const auto& effect : plan.at("effects")) {
          const auto& effect_name = effect.at("name").get_ref<const std::string&>();
          (effect.at("on") ? ever : never).insert(effect_name);
        }
      } else {
        EXPECT_GE(test::expect_same_products(first, folder), kImages + 30U) << name;
      }
    }
  }
  for (const std::string& effect : ever) never.erase(effect);
  // Stars at pixels do not move by themselves, the sub-pixel renderer promises a tolerance instead of bits, and jitter
  // comes from one place at a time.
  EXPECT_THAT(never,
              testing::UnorderedElementsAre("proper-motion", "jitter-file", "sub-pixel-stars", "intra-pixel-response"));
}

TEST(VectorInstructions, AreChosenByTheEnvironment) {
  const test::TemporaryFolder folder;
  for (const std::string& target : vector_targets())
    EXPECT_THAT(test::run_astroid_through({"env", "ASTROID_VECTORS=" + target}, {"doctor"}, folder.path()).out,
                HasSubstr(target + " of " + vector_targets().front()));
  const test::ProgramResult wrong =
      test::run_astroid_through({"env", "ASTROID_VECTORS=NEON"}, {"doctor"}, folder.path());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("one of " + vector_targets().front()));
}

// ---- Other processors, by emulation ----

/// A processor as qemu calls it, and the instructions that the kernels must choose there.
struct Emulated {
  std::string processor;
  std::string vectors;

  friend void PrintTo(const Emulated& emulated, std::ostream* out) { *out << emulated.processor; }
};

class SameOnAnyProcessor : public Processors, public testing::WithParamInterface<Emulated> {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the emulator has no room for the memory that a sanitizer sets aside";
#endif
    if (!test::has_program(kEmulator)) GTEST_SKIP() << kEmulator << " is not installed (Debian: qemu-user)";
    Processors::SetUp();
  }
  static constexpr const char* kEmulator = "qemu-x86_64";
  const Words emulator_{kEmulator, "-cpu", GetParam().processor, "-E", kNoGnuplot};
};

INSTANTIATE_TEST_SUITE_P(Bits, SameOnAnyProcessor,
                         testing::Values(Emulated{"Nehalem", "SSSE3"}, Emulated{"Westmere", "SSE4"},
                                         Emulated{"Haswell", "AVX2"}),
                         [](const auto& test) { return test.param.processor; });

TEST_P(SameOnAnyProcessor, TheWidestInstructionsAreChosen) {
  EXPECT_THAT(test::run_astroid_through(emulator_, {"doctor"}, folder_.path()).out,
              HasSubstr(" " + GetParam().vectors + " of " + GetParam().vectors));
}

// Stars come by pixel and electrons: what WCSLIB computes is not promised to be the same, nor are figures of the
// analysis, which may use the C library's functions.
TEST_P(SameOnAnyProcessor, AreImagesAndLightCurves) {
  for (const Case& scene : cases()) {
    if (scene.name == "Sparse") continue;                            // by direction
    if (scene.name == "Crowded" && scene.method != "psf") continue;  // emulation takes time
    const Words arguments = joined({set(kEveryEffect),
                                    {"--set", "StellarField/Catalogue=field.csv"},
                                    set(scene.parameters),
                                    {"--set", "Photometry/Method=" + scene.method, "--overwrite"}});
    const auto native = run("native", {"env", kNoGnuplot}, arguments);
    const auto emulated = run("emulated", emulator_, arguments);
    EXPECT_GE(test::expect_same_products(native, emulated, {"images/", "steps/", "photometry/", "plan.", "truth/"}),
              kImages + kMaps + 5U)
        << scene.name;
  }
}

TEST_P(SameOnAnyProcessor, AreImagesOfAWholeInstrument) {
  for (const Words& detector : {kCcd, kOtherCcd, kCmos}) {
    const Words arguments = joined({set(kEveryEffect), set(kOptics), set(detector), {"--overwrite"}});
    const auto native = run("native", {"env", kNoGnuplot}, arguments);
    const auto emulated = run("emulated", emulator_, arguments);
    EXPECT_GE(test::expect_same_products(native, emulated, {"images/", "steps/", "photometry/", "plan.", "truth/"}),
              kImages + 20U);
  }
}

}  // namespace
}  // namespace astroid
