// The stream of exposures against a plain loop over them: the same bits, however it divides exposures among blocks,
// batches and threads.
#include "astroid/pipeline/exposure_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "astroid/photometry/background.hpp"
#include "astroid/photometry/light_curves.hpp"
#include "astroid/pipeline/ground.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr int kSide = 48;

// Faint and bright stars, one that saturates in every exposure, one that the edge cuts, and five whose brightest pixel
// reaches the full well of 120,000 e- in some exposures: it holds 35 % of their light and a thousand e- of background.
std::vector<test::LabStar> stars_of_scene() {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 20; ++i)
    stars.push_back({2.0 + 9.1 * (i % 5) + 0.07 * i, 3.0 + 9.3 * (i / 5) - 0.05 * i, 2e4 * std::exp(0.12 * i)});
  for (int i = 0; i < 5; ++i) stars.push_back({5.0 + 9.0 * i, 43.0, 334000.0 + 1200.0 * i});
  stars.push_back({30.0, 16.0, 2e6});
  stars.push_back({kSide - 0.6, 35.0, 5e4});
  return stars;
}

struct Prepared {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  std::vector<StarEstimator> estimators;
};

Prepared prepare(std::int64_t exposures, int cameras, BackgroundMethod background) {
  Mission mission = test::plato_mission(kSide, kSide);
  mission.simulation.exposures = exposures;
  mission.telescope.simulated_cameras = cameras;
  mission.ccd.full_well = Electrons(120000.0);
  mission.ccd.prnu = 0.0;
  mission.photometry.background = background;
  if (background == BackgroundMethod::kMesh) mission.photometry.mesh = 16;
  Prepared run;
  run.scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars_of_scene()));
  run.plan = std::make_shared<const Plan>(make_plan(*run.scene));
  const Ground ground = perfect_ground(*run.scene);
  run.estimators = build_estimators(*run.scene->layout(), ground.model, mission.photometry);
  return run;
}

// What the stream is to find.
struct Expected {
  std::vector<std::vector<std::vector<float>>> deviation;         // [camera][target][exposure]
  std::vector<std::vector<std::vector<std::uint32_t>>> measured;  // flags, [camera][target][exposure]
  std::vector<SeriesSummary> series;
  std::vector<std::uint32_t> flags;
  std::vector<double> flagged_share;
  double lost_electrons = 0.0;
  std::int64_t clipped_pixels = 0;
};

// One exposure after the other, one frame at a time; the whole series of a star in one go.
Expected plain_loop(const Prepared& run, std::span<const double> reference) {
  const Mission& mission = run.scene->mission();
  const auto cameras = static_cast<std::size_t>(mission.telescope.simulated_cameras);
  const auto exposures = static_cast<std::size_t>(mission.simulation.exposures);
  const std::size_t targets = run.estimators.size();
  const EstimatorSet set(run.estimators, mission.ccd.gain, mission.ccd.bias);
  Expected expected;
  expected.deviation.assign(cameras, std::vector(targets, std::vector<float>(exposures)));
  expected.measured.assign(cameras, std::vector(targets, std::vector<std::uint32_t>(exposures)));
  expected.flags.assign(targets, 0);
  std::vector<double> flagged(targets, 0.0);
  std::vector<double> flux(targets);
  std::vector<std::uint32_t> flags(targets);
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    const Simulator simulator(run.scene, run.plan, static_cast<int>(camera));
    ExposureState state = simulator.make_state();
    double lost_electrons = 0.0;
    for (std::size_t k = 0; k < exposures; ++k) {
      simulator.simulate(static_cast<std::int64_t>(k), state);
      lost_electrons += state.lost_electrons;
      expected.clipped_pixels += state.clipped_pixels;
      if (mission.photometry.background == BackgroundMethod::kMesh)
        subtract_background(state.frame, 0, BackgroundMap(state.frame, 0, {.cell = mission.photometry.mesh}));
      set.apply(state.frame, flux, flags);
      for (std::size_t t = 0; t < targets; ++t) {
        expected.deviation[camera][t][k] = static_cast<float>(flux[t] / reference[t] - 1.0);
        expected.measured[camera][t][k] = flags[t];
        expected.flags[t] |= flags[t];
        flagged[t] += flags[t] != 0 ? 1.0 : 0.0;
      }
    }
    expected.lost_electrons += lost_electrons;
  }
  const auto per_bin = static_cast<std::int64_t>(run.scene->summary().exposures_per_bin);
  SeriesStatistics statistics(targets, std::max<std::int64_t>(2, per_bin));
  for (std::size_t t = 0; t < targets; ++t) {
    std::vector<float> mean(exposures);
    for (std::size_t k = 0; k < exposures; ++k) {
      double sum = 0.0;
      for (std::size_t camera = 0; camera < cameras; ++camera)
        sum += static_cast<double>(expected.deviation[camera][t][k]) / static_cast<double>(cameras);
      mean[k] = static_cast<float>(sum);
    }
    statistics.add(t, 0, mean);
    expected.flagged_share.push_back(flagged[t] / static_cast<double>(exposures * cameras));
  }
  expected.series = statistics.summaries();
  return expected;
}

void expect_same(const SeriesSummary& a, const SeriesSummary& b) {
  EXPECT_EQ(a.exposures, b.exposures);
  EXPECT_EQ(a.missing, b.missing);
  EXPECT_EQ(a.bins, b.bins);
  for (const auto& [x, y] : {std::pair{a.mean, b.mean},
                             {a.exposure.value, b.exposure.value},
                             {a.bin_within.value, b.bin_within.value},
                             {a.bin_means.value, b.bin_means.value}})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y)) << x << " and " << y;
}

using Case = std::tuple<int, BackgroundMethod>;  // cameras

class ExposureStream : public testing::TestWithParam<Case> {};

TEST_P(ExposureStream, HasTheBitsOfAPlainLoop) {
  const auto [cameras, background] = GetParam();
  constexpr std::int64_t kExposures = 53;  // a prime: neither blocks nor batches divide it
  const Prepared run = prepare(kExposures, cameras, background);
  const std::size_t targets = run.estimators.size();
  ASSERT_GE(targets, 20U);
  Expected expected;
  std::size_t sometimes_flagged = 0;
  for (const std::int64_t block : {std::int64_t{1024}, std::int64_t{16}, std::int64_t{7}, std::int64_t{1}})
    for (const int threads : {1, 3}) {
      SCOPED_TRACE("blocks of " + std::to_string(block) + ", " + std::to_string(threads) + " threads");
      const test::TemporaryFolder folder;
      const StreamResult result =
          stream_exposures(run.scene, run.plan, run.estimators,
                           {.threads = threads, .folder = folder.path(), .progress = {}, .longest_block = block});
      if (expected.series.empty()) expected = plain_loop(run, result.reference);
      EXPECT_EQ(result.lost_electrons, expected.lost_electrons);
      EXPECT_EQ(result.clipped_pixels, expected.clipped_pixels);
      EXPECT_EQ(result.flags, expected.flags);
      EXPECT_EQ(result.flagged_share, expected.flagged_share);
      const std::string file = (folder.path() / "photometry" / "lightcurves.fits").string();
      for (std::size_t t = 0; t < targets; ++t) {
        SCOPED_TRACE("target " + std::to_string(t));
        expect_same(result.series[t], expected.series[t]);
        const std::string id = run.scene->stars()[run.estimators[t].star].id;
        for (int camera = 1; camera <= cameras; ++camera) {
          const LightCurve curve = read_light_curve(file, id, camera);
          const auto c = static_cast<std::size_t>(camera - 1);
          EXPECT_EQ(curve.flags, expected.measured[c][t]) << "camera " << camera;
          for (std::size_t k = 0; k < curve.flux.size(); ++k)
            EXPECT_EQ(curve.flux[k], result.reference[t] * (1.0 + static_cast<double>(expected.deviation[c][t][k])))
                << "camera " << camera << ", exposure " << k;
        }
        sometimes_flagged += result.flagged_share[t] > 0.0 && result.flagged_share[t] < 1.0 ? 1 : 0;
      }
    }
  EXPECT_GT(sometimes_flagged, 0U) << "the scene was to have stars that saturate in some exposures";
}

INSTANTIATE_TEST_SUITE_P(All, ExposureStream,
                         testing::Values(Case{1, BackgroundMethod::kLocal}, Case{1, BackgroundMethod::kKnown},
                                         Case{1, BackgroundMethod::kMesh}, Case{3, BackgroundMethod::kLocal}));

TEST(ExposureStreamOfImages, CountsProgressToTheEndAndKeepsTheFirstFrame) {
  const Prepared run = prepare(5, 2, BackgroundMethod::kLocal);
  std::atomic<std::int64_t> calls{0};
  std::atomic<std::int64_t> last{0};
  const Progress progress = [&](std::int64_t done, std::int64_t all) {
    EXPECT_EQ(all, 10);
    ++calls;
    std::int64_t seen = last;
    while (seen < done && !last.compare_exchange_weak(seen, done)) {
    }
  };
  const StreamResult result =
      stream_exposures(run.scene, run.plan, {}, {.threads = 2, .folder = {}, .progress = progress});
  EXPECT_EQ(calls, 10);
  EXPECT_EQ(last, 10);
  const Simulator simulator(run.scene, run.plan, 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  ASSERT_EQ(result.first_frame.size(), state.frame.pixels.size());
  EXPECT_TRUE(std::ranges::equal(result.first_frame.pixels(), state.frame.pixels.pixels()));
}

}  // namespace
}  // namespace astroid
