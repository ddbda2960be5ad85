// Memory of a stream does not grow with its exposures.
#include <gtest/gtest.h>
#include <malloc.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "astroid/pipeline/exposure_stream.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

// The most memory that this process ever had, in bytes; 0 where the system does not tell.
std::size_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line))
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

constexpr int kPerSide = 40;

void stream(std::int64_t exposures, int cameras) {
  Mission mission = test::plato_mission(4 * kPerSide, 4 * kPerSide);
  mission.simulation.exposures = exposures;
  mission.telescope.simulated_cameras = cameras;
  mission.photometry.background = BackgroundMethod::kLocal;
  std::vector<test::LabStar> stars;
  for (int i = 0; i < kPerSide * kPerSide; ++i)
    stars.push_back({1.5 + 4.0 * (i % kPerSide), 1.5 + 4.0 * (i / kPerSide), 1e4});
  stars.push_back({80.0, 80.0, 1e7});  // saturated: with its neighbours it has flags in every exposure
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Ground ground = perfect_ground(*scene);
  const std::vector<StarEstimator> estimators = build_estimators(*scene->layout(), ground.model, mission.photometry);
  const test::TemporaryFolder folder;
  const StreamResult result = stream_exposures(
      scene, plan, estimators, {.threads = 2, .folder = folder.path(), .progress = {}, .longest_block = 32});
  EXPECT_EQ(result.series.size(), stars.size());
}

TEST(StreamMemory, DoesNotGrowWithTheExposures) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep memory that was freed";
#endif
  // With an arena for each thread the allocator's own peak differs from run to run by more than what is looked for.
  mallopt(M_ARENA_MAX, 1);
  constexpr std::int64_t kFew = 100;
  constexpr std::int64_t kMany = 2000;
  stream(kFew, 1);
  stream(kFew, 2);
  const std::size_t before = peak_memory();
  if (before == 0) GTEST_SKIP() << "no /proc/self/status";
  stream(kMany, 1);
  stream(kMany / 2, 2);
  // One float for each flux would be 12 MB more. A fifth of that is left for the attitude of each exposure (0.2 MB) and
  // the allocator's fragments.
  constexpr std::size_t kFluxes = (kMany - kFew) * (kPerSide * kPerSide + 1) * sizeof(float);
  EXPECT_LE(peak_memory() - before, kFluxes / 5) << "of " << before << " bytes";
}

}  // namespace
}  // namespace astroid
