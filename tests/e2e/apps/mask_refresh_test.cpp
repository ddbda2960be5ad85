// Masks that follow the stars: a line of sight that drifts by two pixels within a run.
#include <gtest/gtest.h>

#include <algorithm>

#include "program.hpp"
#include "small_mission.hpp"

namespace astroid {
namespace {

double median_noise(const std::filesystem::path& folder) {
  std::vector<double> noise = test::read_csv(folder / "analysis/targets.csv").numbers("nsr_exposure_measured");
  std::sort(noise.begin(), noise.end());
  return noise[noise.size() / 2];
}

TEST(MaskRefresh, KeepsDriftingStarsInTheirMasks) {
  const test::TemporaryFolder folder;
  test::write_small_mission(folder);
  const auto assess = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"assess",
                                       "small.xml",
                                       "-o",
                                       output,
                                       "--set",
                                       "Simulation/Exposures=48",
                                       "--set",
                                       "Satellite/Drift/YawRate=2160",  // 30 arcsec, two pixels, in 20 minutes
                                       "--set",
                                       "CCD/PRNU=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProgramResult run = test::run_astroid(arguments, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return median_noise(folder.path() / output);
  };
  // 100 s are 4 exposures, a sixth of a pixel.
  const std::vector<std::string> refresh{"--set", "Photometry/MaskRefresh=0.0011574074074074074"};
  const double once = assess("once", {});
  std::vector<std::string> one_thread = refresh;
  one_thread.insert(one_thread.end(), {"--threads", "1"});
  std::vector<std::string> two_threads = refresh;
  two_threads.insert(two_threads.end(), {"--threads", "2"});
  const double often = assess("often", one_thread);
  EXPECT_LT(often, 0.2 * once) << "stars leave masks that stay where they were";
  EXPECT_EQ(assess("again", two_threads), often) << "batches are divided where masks change, whoever measures them";
}

}  // namespace
}  // namespace astroid
