// Simulation/Accuracy is a promise: on five hundred random scenes no flux is farther from the converged one than it
// says, whatever the plan chose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/distributions.hpp"
#include "astroid/core/fits_writer.hpp"
#include "astroid/core/random.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr std::uint32_t kScenes = 500;
constexpr int kSide = 48;  // px
constexpr int kExposures = 3;

struct RandomScene {
  Mission mission;
  StarCatalogue stars;
};

std::string table_file() {
  static const test::TemporaryFolder folder;
  static const std::string path = [] {
    constexpr int kSamplesPerPixel = 8;
    const PsfTable table = test::gaussian_psf_table(0.8, kSamplesPerPixel, 6.0);
    FitsWriter fits(folder.path() / "psf.fits");
    fits.begin_image(FitsNumber::kFloat64, {table.samples.nx(), table.samples.ny()});
    fits.card({"SUBPIX", kSamplesPerPixel});
    fits.write_pixels(0, table.samples.pixels());
    fits.commit();
    return (folder.path() / "psf.fits").string();
  }();
  return path;
}

RandomScene random_scene(std::uint32_t number) {
  const RandomStream stream = make_stream(2, StreamId{number}, 0, 0);
  std::uint64_t drawn = 0;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * uniform_at_step(stream, {.step = drawn++});
  };
  const auto decades = [&](double low, double high) { return std::pow(10.0, uniform(low, high)); };
  RandomScene s{.mission = test::bare_mission(kSide, kSide), .stars = {}};
  Mission& m = s.mission;
  m.simulation.seed = number;
  m.simulation.exposures = 1000;
  m.simulation.accuracy = Ppm(decades(-1.0, 3.0));
  m.field.sky_background = ElectronsPerSecond(decades(-1.0, 2.0));
  m.ccd.readout_noise = Electrons(decades(0.0, 2.0));
  m.ccd.full_well = Electrons(decades(4.5, 6.5));
  m.telescope.cameras = uniform(0.0, 1.0) < 0.5 ? 1 : 24;
  if (uniform(0.0, 1.0) < 0.1) {
    m.psf.model = PsfModel::kTable;
    m.psf.file = table_file();
  } else {
    m.psf.sigma = Pixels(uniform(0.35, 1.6));
  }
  if (uniform(0.0, 1.0) < 0.85) {
    m.satellite.jitter.model = JitterModel::kRedNoise;
    m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(decades(-2.0, 0.5));  // 0.0007 … 0.2 px
    m.satellite.jitter.timescale = Seconds(decades(0.5, 3.5));
  }
  const auto count = static_cast<int>(decades(0.0, 2.5));
  std::vector<test::LabStar> stars;
  for (int i = 0; i < count; ++i) stars.push_back({uniform(-1.0, kSide), uniform(-1.0, kSide), decades(3.0, 8.0)});
  stars.push_back({uniform(10.0, kSide - 10.0), uniform(10.0, kSide - 10.0), 1e5});
  s.stars = test::lab_catalogue(stars);
  return s;
}

/// Expected electrons of each exposure, all pixels one after the other.
std::vector<std::vector<double>> images(const Simulator& simulator) {
  ExposureState state = simulator.make_state();
  std::vector<std::vector<double>> all;
  for (std::int64_t k = 0; k < kExposures; ++k) {
    simulator.expect(499 * k, state);
    const auto pixels = std::as_const(state.expected).whole().pixels();
    all.emplace_back(pixels.begin(), pixels.end());
  }
  return all;
}

struct Planned {
  Planned(const Mission& mission, const StarCatalogue& stars, int steps)
      : scene(std::make_shared<const Scene>(mission, stars)),
        plan(std::make_shared<const Plan>(make_plan(*scene, {}, steps))) {}
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
};

TEST(AccuracyPromise, IsKeptOnFiveHundredRandomScenes) {
  std::map<std::string, std::pair<int, double>> by_treatment;  // scenes, and the largest error over the promise
  for (std::uint32_t number = 0; number < kScenes; ++number) {
    const RandomScene random = random_scene(number);
    Mission converged = random.mission;
    converged.simulation.accuracy = Ppm(0.001);
    const Planned exact(converged, random.stars, 1);
    // The same path of the attitude.
    const Planned planned(random.mission, random.stars, exact.plan->knobs.attitude_steps);
    ASSERT_EQ(planned.plan->knobs.attitude_steps, exact.plan->knobs.attitude_steps);
    const auto truth = images(Simulator(exact.scene, exact.plan, 0));
    const auto got = images(Simulator(planned.scene, planned.plan, 0));
    const SceneSummary& summary = planned.scene->summary();
    double worst = 0.0;
    for (const std::size_t target : planned.scene->targets()) {
      const SceneStar& star = planned.scene->stars()[target];
      if (star.electrons > summary.brightest_target_electrons) continue;  // saturated
      const int x0 = static_cast<int>(std::lround(star.position.x));
      const int y0 = static_cast<int>(std::lround(star.position.y));
      if (x0 < 1 || y0 < 1 || x0 > kSide - 2 || y0 > kSide - 2) continue;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        double light = 0.0;
        double error = 0.0;
        for (int y = y0 - 1; y <= y0 + 1; ++y)
          for (int x = x0 - 1; x <= x0 + 1; ++x) {
            const auto pixel = static_cast<std::size_t>(y * kSide + x);
            light += truth[k][pixel] - summary.background;
            error += got[k][pixel] - truth[k][pixel];
          }
        worst = std::max(worst, std::abs(error) / summary.flux_tolerance(std::max(light, star.electrons)));
      }
    }
    const std::string name = planned.plan->renderer + ", " + std::string(to_string(planned.plan->knobs.jitter));
    auto& [count, most] = by_treatment[name];
    ++count;
    most = std::max(most, worst);
    EXPECT_LE(worst, 1.0) << "scene " << number << ": " << name << ", " << random.mission.simulation.accuracy.value()
                          << " ppm, " << random.stars.stars.size() << " stars";
  }
  for (const auto& [name, result] : by_treatment)
    std::printf("%-40s %3d scenes, largest error %.3f of what is promised\n", name.c_str(), result.first,
                result.second);
  EXPECT_GE(by_treatment.size(), 4U);
}

}  // namespace
}  // namespace astroid
