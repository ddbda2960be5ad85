// A crowded field measured with PSF weights, from the configuration to the report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"
#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

constexpr int kSide = 80;
constexpr int kStars = 400;  // one in 16 px: most share pixels with another

/// Writes crowd.csv: magnitudes 9.5 to 13.5, at random places.
void write_crowd(const std::filesystem::path& folder) {
  const RandomStream stream = make_stream(12, StreamId{0xc20d}, 0, 0);
  std::ofstream file(folder / "crowd.csv");
  file << "id,x,y,mag\n";
  for (int i = 0; i < kStars; ++i) {
    const auto step = static_cast<std::uint32_t>(i);
    file << 's' << i << ',' << kSide * uniform_at_step(stream, {.step = step, .axis = 0}) - 0.5 << ','
         << kSide * uniform_at_step(stream, {.step = step, .axis = 1}) - 0.5 << ','
         << 13.5 - 4.0 * std::pow(uniform_at_step(stream, {.step = step, .axis = 2}), 2.0) << '\n';
  }
}

TEST(PsfMethod, HasThePredictedNoiseAndNoBiasInACrowd) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  write_crowd(folder.path());
  constexpr int kExposures = 300;
  const test::ProgramResult run = test::run_astroid({"assess", "small.xml",
                                                     "-o",     "result",
                                                     "--set",  "Photometry/Method=psf",
                                                     "--set",  "StellarField/Catalogue=crowd.csv",
                                                     "--set",  "CCD/Columns=80",
                                                     "--set",  "CCD/Rows=80",
                                                     "--set",  "CCD/PRNU=0",
                                                     "--set",  "CCD/DSNU=0",
                                                     "--set",  "Satellite/Jitter/model=none",
                                                     "--set",  "Simulation/Exposures=" + std::to_string(kExposures)},
                                                    folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(test::read_file(folder.path() / "result/config.xml"), HasSubstr(">psf</Method>"));
  const test::CsvTable targets = test::read_csv(folder.path() / "result/analysis/targets.csv");
  const auto predicted = targets.numbers("nsr_exposure");
  const auto measured = targets.numbers("nsr_exposure_measured");
  const auto flux = targets.numbers("flux_measured");
  const auto error = targets.numbers("flux_err");
  const auto truth = targets.numbers("flux_in");
  const auto bins = targets.numbers("bins");
  double ratios = 0.0;
  double pulls = 0.0;
  double squares = 0.0;
  int stars = 0;
  int blended = 0;
  for (std::size_t i = 0; i < targets.rows(); ++i) {
    const std::string& flags = targets.texts("flags")[i];
    blended += flags == "blended" ? 1 : 0;
    // A star at the edge has the local background of a narrow annulus, one lost in the noise no noise relative to it.
    if (!(flags.empty() || flags == "blended") || predicted[i] > 0.1) continue;
    ratios += measured[i] / predicted[i];
    const double pull = (flux[i] - truth[i]) / error[i];
    pulls += pull;
    squares += pull * pull;
    ++stars;
  }
  std::printf("%d stars, %d blended: measured / predicted noise %.4f, pulls %+.3f ± %.3f\n", stars, blended,
              ratios / stars, pulls / stars, std::sqrt(squares / stars));
  EXPECT_GT(stars, kStars / 2);
  EXPECT_GT(blended, 0);
  EXPECT_NEAR(ratios / stars, 1.0, 4.0 / std::sqrt(2.0 * kExposures * stars));
  EXPECT_NEAR(pulls / stars, 0.0, 4.0 / std::sqrt(stars));
  // The error of a mean comes from the scatter of the bins, which adds 1 / (4 bins) to its width.
  EXPECT_NEAR(std::sqrt(squares / stars), 1.0, 4.0 / std::sqrt(2.0 * stars) + 1.0 / (4.0 * bins[0]));
}

TEST(PsfMethod, IsBudgetedWithoutASimulation) {
  const test::TemporaryFolder folder;
  const auto nsr_of = [&folder](const std::string& method, const std::string& neighbour) {
    const std::string output = method + neighbour + ".csv";
    const test::ProgramResult run =
        test::run_astroid({"budget", "plato", "--analytic", "--from", "11", "--to", "11", "--set",
                           "Photometry/Method=" + method, "--neighbour", neighbour, "-o", output},
                          folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return test::read_csv(folder.path() / output);
  };
  const test::CsvTable mask = nsr_of("mask", "1.5,0,1");
  const test::CsvTable psf = nsr_of("psf", "1.5,0,1");
  EXPECT_NEAR(psf.numbers("enclosed_fraction")[0], 1.0, 1e-6);
  EXPECT_EQ(psf.numbers("spr_tot")[0], 0.0);
  EXPECT_GT(mask.numbers("spr_tot")[0], 0.01);
  EXPECT_LT(psf.numbers("jitter_ppm")[0], 0.1 * mask.numbers("jitter_ppm")[0]) << "the weights know of the jitter";
  EXPECT_LT(nsr_of("psf", "30,0,1").numbers("nsr_exposure")[0], nsr_of("mask", "30,0,1").numbers("nsr_exposure")[0]);
}

}  // namespace
}  // namespace astroid
