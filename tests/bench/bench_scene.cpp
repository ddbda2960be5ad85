#include "bench_scene.hpp"

#include <ctime>
#include <filesystem>
#include <limits>
#include <string>

#include "astroid/core/configuration.hpp"
#include "astroid/core/distributions.hpp"
#include "astroid/core/math.hpp"
#include "astroid/pipeline/field.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid::bench {

namespace {

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  constexpr double kNanosecond = 1e-9;
  return static_cast<double>(time.tv_sec) + kNanosecond * static_cast<double>(time.tv_nsec);
}

}  // namespace

PlannedScene plan_scene(const Mission& mission, const StarCatalogue& catalogue) {
  PlannedScene planned;
  planned.scene = std::make_shared<const Scene>(mission, catalogue);
  planned.plan = std::make_shared<const Plan>(make_plan(*planned.scene));
  return planned;
}

Mission reference_mission(int side, Detector detector) {
  Mission mission = test::plato_mission(side, side);
  mission.psf.sigma = Pixels(0.65);
  mission.field.sky_background = ElectronsPerSecond(60.0 / mission.simulation.exposure_time.value());
  mission.ccd.readout_noise = Electrons(25.0);
  mission.ccd.full_well = Electrons(500000.0);  // so that the brightest stars bloom
  if (detector == Detector::kEverything) return mission;
  mission.ccd.dark_current = ElectronsPerSecond(0.0);
  mission.ccd.dsnu = 0.0;
  mission.ccd.prnu = 0.0;
  mission.ccd.bias = Adu(0.0);
  mission.ccd.full_well = Electrons(1e12);
  return mission;
}

StarCatalogue reference_stars(std::uint32_t stars, int side) {
  constexpr double kBright = 8.0;
  constexpr double kFaint = 15.0;
  constexpr double kSlope = 0.25;
  constexpr std::uint64_t kSeed = 8;
  const RandomStream stream = make_stream(kSeed, StreamId{0xbe7c}, 0, 0);
  StarCatalogue catalogue;
  catalogue.source = "benchmark";
  catalogue.passband = "P";
  catalogue.positions = PositionKind::kPixel;
  const double fewest = det::exp10(-kSlope * (kFaint - kBright));
  for (std::uint32_t i = 0; i < stars; ++i) {
    CatalogueStar star;
    star.id = "star" + std::to_string(i + 1);
    star.pixel = {side * uniform_at_step(stream, {.step = i, .axis = 0}) - 0.5,
                  side * uniform_at_step(stream, {.step = i, .axis = 1}) - 0.5};
    const double share = uniform_at_step(stream, {.step = i, .axis = 2});
    star.magnitude = Magnitude(kFaint + det::log10(fewest + (1.0 - fewest) * share) / kSlope);
    star.colour = std::numeric_limits<double>::quiet_NaN();
    star.teff = std::numeric_limits<double>::quiet_NaN();
    catalogue.stars.push_back(star);
  }
  return catalogue;
}

Mission week_mission(std::int64_t exposures) {
  const std::filesystem::path root = test::source_dir();
  Mission mission =
      read_configuration(root / "apps" / "missions" / "plato-week.xml", {.overrides = {}, .data_folders = {root}})
          .mission;
  mission.simulation.exposures = exposures;
  return mission;
}

StarCatalogue week_stars(const Mission& mission) {
  return load_field(mission);
}

double thread_cpu_seconds() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}
double process_cpu_seconds() {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace astroid::bench
