// Windows and sub-fields have the bits of the full frame whatever happens to charge outside them: blooming, charge
// transfer and tracks that come in; reference pixels too.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

constexpr int kColumns = 130;
constexpr int kRows = 170;

/// Faint stars all over, and some that saturate: alone, at an edge, and in one column of a target.
std::vector<test::LabStar> stars() {
  std::vector<test::LabStar> all;
  for (int i = 0; i < 24; ++i)
    all.push_back({5.3 + 5.1 * i, 6.0 + static_cast<double>((i * 67) % 160), 4e3 + 300.0 * i});
  all.push_back({40.2, 80.3, 9e5});
  all.push_back({40.9, 120.1, 3e5});
  all.push_back({101.0, 166.0, 1.2e6});
  all.push_back({0.2, 20.0, 6e5});
  return all;
}

Mission mission() {
  Mission m = test::bare_mission(kColumns, kRows);
  m.field.sky_background = ElectronsPerSecond(30.0);
  m.ccd.readout_noise = Electrons(5.0);
  m.ccd.full_well = Electrons(5e4);
  m.ccd.reference = {.prescan = 4, .serial_overscan = 6, .parallel_overscan = 7};
  return m;
}

ExposureState exposure_of(const Mission& m, std::shared_ptr<const Scene>& scene) {
  scene = std::make_shared<const Scene>(m, test::lab_catalogue(stars()));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(1, state);
  std::printf("%zu px delivered, %zu px computed\n", scene->layout()->size(), plan->layout->size());
  return state;
}

struct Case {
  const char* name;
  std::function<void(Mission&)> set;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class DetectorWindows : public testing::TestWithParam<Case> {};

TEST_P(DetectorWindows, HaveTheBitsOfTheFullFrame) {
  Mission full = mission();
  GetParam().set(full);
  std::shared_ptr<const Scene> full_scene;
  const ExposureState expected = exposure_of(full, full_scene);
  Mission windows = full;
  windows.ccd.window = 6;
  windows.photometry.mask_window = 6;
  Mission sub = full;
  sub.ccd.has_sub_field = true;
  sub.ccd.sub_x0 = 33;
  sub.ccd.sub_y0 = 90;
  sub.ccd.sub_columns = 50;
  sub.ccd.sub_rows = 40;
  Mission corner = sub;
  corner.ccd.sub_x0 = 90;
  corner.ccd.sub_columns = 40;
  corner.ccd.sub_y0 = 150;
  corner.ccd.sub_rows = 20;
  for (const Mission& part : {windows, sub, corner}) {
    std::shared_ptr<const Scene> scene;
    const ExposureState state = exposure_of(part, scene);
    const PixelLayout& layout = *scene->layout();
    const PixelLayout& all = *full_scene->layout();
    std::size_t different = 0;
    std::size_t compared = 0;
    for (std::size_t r = 0; r < layout.regions().size(); ++r) {
      const Rectangle& area = layout.regions()[r];
      for (std::size_t q = 0; q < all.regions().size(); ++q) {
        const Rectangle common = intersect(area, all.regions()[q]);
        for (int y = common.y0; y < common.y1(); ++y)
          for (int x = common.x0; x < common.x1(); ++x) {
            ++compared;
            different += state.frame.pixels.view(r).at(x, y) != expected.frame.pixels.view(q).at(x, y) ||
                         state.frame.flags.view(r).at(x, y) != expected.frame.flags.view(q).at(x, y);
          }
      }
    }
    EXPECT_EQ(compared, layout.size());
    EXPECT_EQ(different, 0U) << layout.regions().size() << " regions";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Effects, DetectorWindows,
    testing::Values(
        Case{"Blooming", [](Mission&) {}},
        Case{"BloomingOnChargeInjection",
             [](Mission& m) { m.ccd.charge_injection = {.every_rows = 20, .first_row = 5, .level = Electrons(2e4)}; }},
        Case{"SimpleCti",
             [](Mission& m) {
               m.ccd.cti.model = CtiModel::kSimple;
               m.ccd.cti.parallel = 3e-4;
               m.ccd.cti.serial = 2e-4;
             }},
        Case{"SerialCtiAlone",
             [](Mission& m) {
               m.ccd.cti.model = CtiModel::kSimple;
               m.ccd.cti.serial = 2e-3;
             }},
        Case{"SimpleCtiThroughTwoNodes",
             [](Mission& m) {
               m.ccd.cti.model = CtiModel::kSimple;
               m.ccd.cti.parallel = 1e-5;
               m.ccd.cti.serial = 2e-4;
               m.ccd.nodes.count = 2;
             }},
        Case{"Traps",
             [](Mission& m) {
               m.ccd.cti.model = CtiModel::kTraps;
               m.ccd.cti.trap_density = {4.9, 6.62};
               m.ccd.cti.register_density = {0.5, 0.1};
               m.ccd.cti.trap_cross_section = {2.46e-20, 2.45e-23};
               m.ccd.cti.trap_release_time = {2.37e-4, 0.14};
             }},
        Case{"SmearingThroughFourNodes",
             [](Mission& m) {
               m.ccd.smearing = {
                   .model = SmearingModel::kFrameTransfer, .time = Seconds(4.0), .clear_time = Seconds(1.0)};
               m.ccd.nodes.count = 4;
             }},
        Case{"PersistenceAndRollingShutter",
             [](Mission& m) {
               m.simulation.type = DetectorType::kCmos;
               m.ccd.reference = {};
               m.cmos.persistence = {.fraction = {0.01}, .time = {100.0}};
               m.cmos.line_time = Seconds(0.1);
               m.satellite.jitter.model = JitterModel::kRedNoise;
               m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(1.0);
             }},
        Case{"Everything",
             [](Mission& m) {
               m.ccd.flat_field.rms = 0.01;
               m.ccd.charge_injection = {.every_rows = 30, .first_row = 5, .level = Electrons(2e3)};
               m.ccd.cosmic_rays.rate = 200.0;
               m.ccd.brighter_fatter = {.serial = 3e-7, .parallel = 4e-7, .decay = 0.5, .range = 3};
               m.ccd.cti.model = CtiModel::kSimple;
               m.ccd.cti.parallel = 1e-5;
               m.ccd.cti.serial = 1e-5;
               m.ccd.nodes = {.count = 2, .gain_factor = {1.02, 0.97}, .noise_factor = {1.1, 0.9}, .cross_talk = 1e-3};
               m.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(4.0)};
               m.ccd.bad_pixels.dead = m.ccd.bad_pixels.hot = 0.01;
               m.ccd.electronics.nonlinearity = {0.0, -0.0042789409, 2.365e-7};
               m.ccd.electronics.bias_drift = 3.0;
               m.ccd.electronics.gain_drift = 1e-3;
               m.ccd.electronics.row_offset = 2.0;
               m.ccd.pixel_scale = PixelScale(100.0);
               m.telescope.vignetting.model = VignettingModel::kCosineSquared;
               m.telescope.ghosts = {.fraction = 1e-3, .radius = Pixels(20.0), .brighter_than = Magnitude(30.0)};
               m.psf.breathing = {.amplitude = Pixels(0.1), .period = Seconds(900.0)};
               m.field.stray_light = {ElectronsPerSecond(9.0), 0.5, -0.5};
               m.satellite.jitter.model = JitterModel::kRedNoise;
               m.satellite.jitter.yaw = m.satellite.jitter.pitch = Arcseconds(4.0);
             }}),
    [](const testing::TestParamInfo<Case>& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace astroid
