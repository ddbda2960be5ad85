// The same configuration gives the same bits: for any number of threads, in a window, in a longer run, beside other
// effects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "astroid/core/fits_reader.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using Pixels2 = Image<double, unit::Adu>;

Pixels2 image_of(const std::filesystem::path& file) {
  const FitsReader fits(file);
  return fits.read_image<double, unit::Adu>(1);
}

class Bits : public testing::Test {
 protected:
  void SetUp() override { test::write_small_mission(folder_); }
  std::filesystem::path run(const std::string& command, const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{command, "small.xml", "-o", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProgramResult result = test::run_astroid_through(runner_, arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return folder_.path() / name;
  }
  test::TemporaryFolder folder_;
  std::vector<std::string> runner_;
};

TEST_F(Bits, OfImagesAndLightCurvesAreTheSameForAnyNumberOfThreads) {
  const std::vector<std::string> settings{"--set", "Output/Images=all", "--set", "Simulation/Exposures=11"};
  std::vector<std::filesystem::path> runs;
  for (const char* threads : {"1", "2", "3"}) {
    std::vector<std::string> more{"--threads", threads};
    more.insert(more.end(), settings.begin(), settings.end());
    runs.push_back(run("assess", std::string("threads") + threads, more));
  }
  for (const std::size_t other : {1U, 2U}) EXPECT_GE(test::expect_same_products(runs[0], runs[other]), 11U + 10U);
}

TEST_F(Bits, OfASubFieldAreThoseOfTheFullFrame) {
  const auto full = run("simulate", "full", {"--set", "Output/Images=all"});
  const auto part = run("simulate", "part",
                        {"--set", "Output/Images=all", "--set", "CCD/SubField/x=31", "--set", "CCD/SubField/y=17",
                         "--set", "CCD/SubField/columns=47", "--set", "CCD/SubField/rows=64"});
  for (const char* name : {"images/camera1_000000.fits", "images/camera1_000005.fits"}) {
    const Pixels2 whole = image_of(full / name);
    const Pixels2 window = image_of(part / name);
    ASSERT_EQ(window.nx(), 47);
    ASSERT_EQ(window.ny(), 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 47; ++x) ASSERT_EQ(window.at(x, y), whole.at(x + 31, y + 17)) << x << " " << y;
  }
}

TEST_F(Bits, OfWindowsAroundTargetsAreThoseOfTheFullFrame) {
  const auto full = run("simulate", "full", {});
  const auto part = run("simulate", "part", {"--set", "CCD/Window=12"});
  const Pixels2 whole = image_of(full / "images/camera1_000000.fits");
  const FitsReader fits(part / "images/camera1_000000.fits");
  const std::optional<int> windows = fits.find_unit("WINDOWS");
  ASSERT_TRUE(windows);
  const auto column = [&](const char* name) {
    const auto index = fits.find_column(*windows, name);
    return index ? fits.read_integers(*windows, *index) : std::vector<std::int64_t>{};
  };
  const auto x0 = column("X0");
  const auto y0 = column("Y0");
  ASSERT_EQ(x0.size(), 25U);
  ASSERT_EQ(fits.units().front().axes, (std::vector<std::int64_t>{12, 12, 25}));
  std::vector<double> window(144);
  for (std::size_t r = 0; r < x0.size(); ++r) {
    fits.read_pixels(1, static_cast<std::int64_t>(r) * 144, window);
    for (int i = 0; i < 144; ++i)
      ASSERT_EQ(window[static_cast<std::size_t>(i)],
                whole.at(static_cast<int>(x0[r]) + i % 12, static_cast<int>(y0[r]) + i / 12))
          << "window " << r << ", pixel " << i;
  }
}

// The faintest target lies outside the sub-field: what is neglected must not depend on which targets are computed.
class BitsOfPhotometry : public Bits, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    Bits::SetUp();
    runner_ = {"env", "PATH=/"};  // without gnuplot, whose drawings take longer than all the rest
    test::write_pixel_field(folder_.path() / "field.csv", 100, 60, "faintest,3,4,60\n");
    constexpr int kCrowd = 1400;  // 14 stars in 100 px
    test::write_pixel_field(folder_.path() / "crowd.csv", 100, kCrowd, "faintest,3,4,60\n");
  }
  /// The flux series of a target, camera by camera and combined.
  static std::vector<float> series(const FitsReader& fits, std::size_t target) {
    constexpr std::size_t kExposures = 6;
    std::vector<float> all;
    for (const char* unit : {"CAMERA1", "CAMERA2", "COMBINED"}) {
      std::vector<float> flux(kExposures);
      fits.read_pixels(fits.find_unit(unit).value(), static_cast<std::int64_t>(target * kExposures), flux);
      all.insert(all.end(), flux.begin(), flux.end());
    }
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, BitsOfPhotometry, testing::Values("mask", "weighted", "psf"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(BitsOfPhotometry, InWindowsAndASubFieldAreThoseOfTheFullFrame) {
  constexpr int kX = 20;
  constexpr int kY = 12;
  constexpr int kSide = 70;
  constexpr double kBackground = 8.0 + 2.0;  // px: the ring of the local background, and what a mask adds
  for (const char* catalogue : {"field.csv", "crowd.csv"}) {
    const std::vector<std::string> settings{"--set",      std::string("StellarField/Catalogue=") + catalogue,
                                            "--set",      std::string("Photometry/Method=") + GetParam(),
                                            "--set",      "Telescope/SimulatedCameras=2",
                                            "--set",      "Output/Images=none",
                                            "--overwrite"};
    const auto assess = [&](const std::string& name, std::vector<std::string> more) {
      more.insert(more.end(), settings.begin(), settings.end());
      return run("assess", name, more);
    };
    const auto full = assess("full", {});
    const auto windows = assess("windows", {"--set", "CCD/Window=24"});
    const auto part = assess("part", {"--set", "CCD/SubField/x=20", "--set", "CCD/SubField/y=12", "--set",
                                      "CCD/SubField/columns=70", "--set", "CCD/SubField/rows=70"});
    const test::CsvTable all = test::read_csv(full / "photometry/sources.csv");
    const FitsReader all_curves(full / "photometry/lightcurves.fits");
    for (const auto& folder : {windows, part}) {
      EXPECT_THAT(test::read_file(folder / "plan.json"), testing::HasSubstr("\"approximations\": []"));
      const test::CsvTable some = test::read_csv(folder / "photometry/sources.csv");
      const FitsReader curves(folder / "photometry/lightcurves.fits");
      const auto x = some.numbers("x");
      const auto y = some.numbers("y");
      std::size_t compared = 0;
      for (std::size_t i = 0; i < some.rows(); ++i) {
        const auto inside = [&](double v, int first) {
          return v >= first + kBackground && v <= first + kSide - 1 - kBackground;
        };
        if (folder == part && !(inside(x[i], kX) && inside(y[i], kY))) continue;
        const auto& ids = all.texts("id");
        const auto star = static_cast<std::size_t>(std::ranges::find(ids, some.texts("id")[i]) - ids.begin());
        ASSERT_LT(star, ids.size());
        for (const std::string& column : some.names)
          EXPECT_EQ(some.texts(column)[i], all.texts(column)[star])
              << column << " of " << ids[star] << " in " << folder;
        EXPECT_EQ(series(curves, i), series(all_curves, star)) << ids[star] << " in " << folder;
        ++compared;
      }
      EXPECT_GE(compared, folder == part ? all.rows() / 8 : all.rows());
    }
  }
}

TEST_F(Bits, OfALongerRunBeginWithThoseOfTheShorterOne) {
  const auto shorter = run("assess", "short", {"--set", "Output/Images=all"});
  const auto longer = run("assess", "long", {"--set", "Output/Images=all", "--set", "Simulation/Exposures=17"});
  for (int exposure = 0; exposure < 6; ++exposure) {
    const std::string name = "images/camera1_00000" + std::to_string(exposure) + ".fits";
    const Pixels2 a = image_of(shorter / name);
    const Pixels2 b = image_of(longer / name);
    for (int y = 0; y < a.ny(); ++y)
      for (int x = 0; x < a.nx(); ++x) ASSERT_EQ(a.at(x, y), b.at(x, y)) << name << " " << x << " " << y;
  }
  const FitsReader a(shorter / "photometry/lightcurves.fits");
  const FitsReader b(longer / "photometry/lightcurves.fits");
  const auto unit_a = a.find_unit("CAMERA1");
  const auto unit_b = b.find_unit("CAMERA1");
  ASSERT_TRUE(unit_a && unit_b);
  std::vector<float> series_a(6);
  std::vector<float> series_b(6);
  for (int star = 0; star < 25; ++star) {
    a.read_pixels(*unit_a, star * 6, series_a);
    b.read_pixels(*unit_b, star * 17, series_b);
    EXPECT_EQ(series_a, series_b) << star;
  }
}

// The map after readout noise less the map before it is the noise itself, which no other effect may change.
TEST_F(Bits, OfTheReadoutNoiseStayWhenPrnuIsOff) {
  const auto with = run("simulate", "with", {"--dump-steps", "2"});
  const auto without = run("simulate", "without", {"--dump-steps", "2", "--set", "CCD/PRNU=0"});
  const auto step = [](const std::filesystem::path& folder, const std::string& effect) {
    for (const std::string& file : test::files_below(folder / "steps"))
      if (file.ends_with("_" + effect + ".fits")) return image_of(folder / "steps" / file);
    return Pixels2();
  };
  const Pixels2 noisy_with = step(with, "readout-noise");
  const Pixels2 noisy_without = step(without, "readout-noise");
  const Pixels2 drawn_with = step(with, "photon-noise");
  const Pixels2 drawn_without = step(without, "photon-noise");
  ASSERT_EQ(noisy_with.nx(), 100);
  ASSERT_EQ(drawn_without.nx(), 100);
  EXPECT_EQ(step(without, "prnu").nx(), 0) << "PRNU was to be off";
  double squares = 0.0;
  bool other_electrons = false;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const double noise = noisy_with.at(x, y) - drawn_with.at(x, y);
      // The sums round to the last bit of numbers below 2^20.
      constexpr double kRounding = 1e-9;
      ASSERT_NEAR(noise, noisy_without.at(x, y) - drawn_without.at(x, y), kRounding) << x << " " << y;
      other_electrons = other_electrons || drawn_with.at(x, y) != drawn_without.at(x, y);
      squares += noise * noise;
    }
  EXPECT_TRUE(other_electrons) << "PRNU must change the electrons";
  // Five standard errors of an rms of 10^4 draws.
  EXPECT_NEAR(std::sqrt(squares / 1e4), 50.2, 5 * 50.2 / std::sqrt(2e4));
}

}  // namespace
}  // namespace astroid
