// What the optics do to light: distortion, vignetting, throughput, breathing, ghosts.
#include "astroid/sim/optics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "astroid/core/throughput.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/plato_distortion.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

struct Camera {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  std::unique_ptr<const Simulator> simulator;

  Camera(const Mission& mission, const StarCatalogue& catalogue)
      : scene(std::make_shared<const Scene>(mission, catalogue)),
        plan(std::make_shared<const Plan>(make_plan(*scene))),
        simulator(std::make_unique<const Simulator>(scene, plan, 0)) {}

  [[nodiscard]] std::vector<double> expected(std::int64_t exposure) const {
    ExposureState state = simulator->make_state();
    simulator->expect(exposure, state);
    const auto pixels = state.expected.whole().pixels();
    return {pixels.begin(), pixels.end()};
  }
};

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// PLATO's vignetting on a detector of 1 arcmin/px, up to 18 deg from the axis in a corner.
Mission vignetted_mission(int side) {
  Mission mission = test::bare_mission(side, side);
  mission.ccd.pixel_scale = PixelScale(60.0);
  mission.ccd.axis_x = mission.ccd.axis_y = -10.0;
  mission.telescope.vignetting.model = VignettingModel::kPolynomial;
  mission.telescope.vignetting.polynomial = {4.18e-2, -5.65e-5, 2.37e-7};
  return mission;
}

TEST(Vignetting, HasPlatosValues) {
  const VignettingSettings plato{VignettingModel::kPolynomial, {4.18e-2, -5.65e-5, 2.37e-7}};
  EXPECT_EQ(vignetting_at(plato, Degrees(0.0)), 1.0);
  EXPECT_NEAR(vignetting_at(plato, Degrees(10.0)), 1.0 - 0.01 * (4.18 - 0.565 + 0.237), 1e-12);
  EXPECT_NEAR(vignetting_at(plato, Degrees(test::kPlatoFieldRadius)), 0.815, 1e-3);
  // Its mean over the field is 0.920.
  double sum = 0.0;
  double weights = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double angle = test::kPlatoFieldRadius * (i + 0.5) / 2000.0;
    const double weight = std::sin(angle * kPi / 180.0);
    sum += weight * vignetting_at(plato, Degrees(angle));
    weights += weight;
  }
  EXPECT_NEAR(sum / weights, 0.920, 0.004);
  EXPECT_EQ(vignetting_at({VignettingModel::kPolynomial, {1.0}}, Degrees(20.0)), 0.0);   // never negative
  EXPECT_EQ(vignetting_at({VignettingModel::kPolynomial, {-1.0}}, Degrees(20.0)), 1.0);  // never more than all
  EXPECT_NEAR(vignetting_at({VignettingModel::kCosineSquared, {}}, Degrees(60.0)), 0.25, 1e-15);
}

TEST(Vignetting, IsThatOfThePixelsFieldAngle) {
  constexpr int kSide = 700;
  Mission mission = vignetted_mission(kSide);
  mission.telescope.distortion.model = DistortionModel::kRadial;
  mission.telescope.distortion.radial = {0.32419, 0.0232909, 0.407979};
  mission.field.sky_background = ElectronsPerSecond(1000.0);
  const Camera camera(mission, test::lab_catalogue({{300.0, 300.0, 1e5}}));
  ASSERT_TRUE(camera.plan->runs("vignetting"));
  const std::vector<double> image = camera.expected(0);
  const double sky = 1000.0 * mission.simulation.exposure_time.value();
  double worst = 0.0;
  for (int y = 0; y < kSide; y += 23)
    for (int x = 0; x < kSide; x += 19) {
      if (std::hypot(x - 300, y - 300) < 10.0) continue;  // the star
      const double exact = vignetting_at(mission.telescope.vignetting, *camera.scene->projection(),
                                         {static_cast<double>(x), static_cast<double>(y)});
      worst = std::max(worst, std::abs(image[static_cast<std::size_t>(y * kSide + x)] / sky - exact));
    }
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(camera.scene->summary().least_vignetting, 0.93);
}

TEST(Vignetting, LeavesAStarTheElectronsThatTheSceneSays) {
  const Mission mission = vignetted_mission(400);
  for (const PixelPosition p : {PixelPosition{20.3, 30.1}, {200.0, 150.4}, {380.2, 379.9}}) {
    const Camera camera(mission, test::lab_catalogue({{p.x, p.y, 1e6}}));
    const SceneStar& star = camera.scene->stars()[0];
    EXPECT_LT(star.response, 1.0);
    EXPECT_NEAR(star.electrons, 1e6 * star.response, 1e-3);
    EXPECT_NEAR(sum_of(camera.expected(0)) / star.electrons, 1.0, 1e-6);
  }
}

TEST(Throughput, FallsLinearlyOverTheYears) {
  Mission mission = test::bare_mission(60, 60);
  mission.simulation.cycle = Seconds(86400.0 * 36.525);  // a tenth of a year
  mission.simulation.exposures = 101;
  mission.telescope.throughput = {
      .beginning_of_life = 0.9, .end_of_life = 0.8, .lifetime_years = 5.0, .age_years = 1.0};
  mission.field.sky_background = ElectronsPerSecond(2.0);
  const Camera camera(mission, test::lab_catalogue({{30.0, 30.0, 1e6}}));
  ASSERT_TRUE(camera.plan->runs("throughput"));
  const double light = 1e6 + 3600.0 * 2.0 * mission.simulation.exposure_time.value();
  for (const std::int64_t exposure : {0, 10, 50, 100}) {
    const double years = 1.0 + 0.1 * static_cast<double>(exposure);
    const double passed = 0.9 * (1.0 - 0.2 * years / 5.0);
    EXPECT_NEAR(sum_of(camera.expected(exposure)) / light, passed, 2e-6) << exposure;
  }
  EXPECT_NEAR(camera.scene->stars()[0].response, 0.9 * (1.0 - 0.2 * 6.0 / 5.0), 1e-6);  // the mean over the run
  EXPECT_EQ(throughput_at(mission, Seconds(1e12)), 0.0);
}

TEST(Throughput, SharesEpochsThatAreShortEnough) {
  Mission mission = test::bare_mission(60, 60);
  mission.simulation.exposures = 100000;
  mission.telescope.throughput = {
      .beginning_of_life = 1.0, .end_of_life = 0.9, .lifetime_years = 0.5, .age_years = 0.0};
  const Camera camera(mission, test::lab_catalogue({{30.0, 30.0, 1e7}}));
  const std::int64_t epoch = camera.plan->epoch_exposures;
  ASSERT_GT(epoch, 0);
  const double tolerance = camera.scene->summary().flux_tolerance(1e7);
  double worst = 0.0;
  for (const std::int64_t exposure : {std::int64_t{0}, epoch / 2, epoch - 1, epoch, 5 * epoch + epoch / 3}) {
    const double exact = 1e7 * throughput_at(mission, camera.scene->mid_time(exposure));
    worst = std::max(worst, std::abs(sum_of(camera.expected(exposure)) - exact));
  }
  EXPECT_LT(worst, 0.5 * tolerance);
}

TEST(Breathing, WidensTheGaussianByItsVariance) {
  Mission mission = test::bare_mission(40, 40);
  mission.simulation.exposures = 200;
  mission.psf.breathing = {.amplitude = Pixels(0.3), .period = Seconds(2500.0), .phase = 0.0};
  const Camera camera(mission, test::lab_catalogue({{20.2, 19.7, 1e6}}));
  ASSERT_TRUE(camera.plan->runs("breathing"));
  for (const std::int64_t exposure : {0, 25, 50, 75, 120}) {
    const double turns = camera.scene->mid_time(exposure).value() / 2500.0;
    const double variance = 0.09 * 0.5 * (1.0 - std::cos(2.0 * kPi * turns));
    const auto wide = make_gaussian_psf(std::sqrt(mission.psf.sigma.value() * mission.psf.sigma.value() + variance));
    std::vector<double> fractions(1600);
    wide->integrate(camera.scene->stars()[0].position, {0, 0, 40, 40}, fractions);
    const std::vector<double> image = camera.expected(exposure);
    double worst = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) worst = std::max(worst, std::abs(image[i] - 1e6 * fractions[i]));
    EXPECT_LT(worst, 2.0) << exposure;  // 2 ppm
  }
}

Mission ghostly_mission(int side) {
  Mission mission = test::bare_mission(side, side);
  mission.telescope.ghosts = {.fraction = 1e-3, .radius = Pixels(11.7), .brighter_than = Magnitude(9.0)};
  return mission;
}

TEST(Ghosts, AreDiscsOppositeToTheirStars) {
  constexpr int kSide = 200;
  Mission mission = ghostly_mission(kSide);
  mission.ccd.axis_x = 90.0;
  mission.ccd.axis_y = 101.25;
  const auto catalogue = test::lab_catalogue({{40.3, 60.2, 1e7}, {150.0, 40.0, 1e3}});  // the second is too faint
  const Camera camera(mission, catalogue);
  ASSERT_TRUE(camera.plan->runs("ghosts"));
  Mission without = mission;
  without.telescope.ghosts.fraction = 0.0;
  const std::vector<double> with_ghost = camera.expected(0);
  const std::vector<double> stars = Camera(without, catalogue).expected(0);
  double sum = 0.0;
  double x_mean = 0.0;
  double y_mean = 0.0;
  double brightest = 0.0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const double ghost = with_ghost[i] - stars[i];
    sum += ghost;
    x_mean += ghost * static_cast<double>(i % kSide);
    y_mean += ghost * static_cast<double>(i / kSide);
    brightest = std::max(brightest, ghost);
  }
  EXPECT_NEAR(sum, 1e4, 1e-6);  // the light is kept
  // Light at the centres of the pixels that the edge cuts is up to a thousandth of a pixel from where it fell.
  EXPECT_NEAR(x_mean / sum, 2.0 * 90.0 - 40.3, 1e-3);
  EXPECT_NEAR(y_mean / sum, 2.0 * 101.25 - 60.2, 1e-3);
  EXPECT_NEAR(brightest, 1e4 / (kPi * 11.7 * 11.7), 1e-8);  // and uniform
}

TEST(Ghosts, ComeFromStarsBesideTheDetectorToo) {
  const Mission mission = [] {
    Mission m = ghostly_mission(100);
    m.ccd.axis_x = -20.0;  // the detector is to the right of the axis
    m.ccd.axis_y = 50.0;
    return m;
  }();
  const Camera camera(mission, test::lab_catalogue({{-90.0, 50.0, 1e7}, {50.0, 50.0, 1e3}}));
  ASSERT_EQ(camera.scene->ghosts().size(), 1U);
  EXPECT_EQ(camera.scene->ghosts()[0].position.x, 50.0);
  EXPECT_NEAR(sum_of(camera.expected(0)), 1e4 + 1e3, 1e-3);
}

TEST(Ghosts, MoveAgainstTheirStars) {
  const Mission mission = ghostly_mission(100);
  const Scene scene(mission, test::lab_catalogue({{30.0, 40.0, 1e7}}));
  const AttitudeJacobian& star = scene.stars()[0].motion;
  const AttitudeJacobian& ghost = scene.ghosts()[0].motion;
  EXPECT_EQ(ghost.dx_dyaw, -star.dx_dyaw);
  EXPECT_EQ(ghost.dy_droll, -star.dy_droll);
  EXPECT_NE(star.dx_dyaw, 0.0);
}

TEST(Distortion, OfAMissionMovesStarsTruthAndMotionAlike) {
  Mission mission = test::bare_mission(4510, 4510);
  mission.ccd.axis_x = mission.ccd.axis_y = -82.5;
  mission.telescope.distortion.model = DistortionModel::kRadial;
  const RadialTangential plato = test::plato_distortion();
  mission.telescope.distortion.radial = {plato.k1, plato.k2, plato.k3};
  mission.telescope.distortion.tangential = {plato.p1, plato.p2};
  mission.telescope.distortion.prism = {plato.s1, plato.s2};
  Mission perfect = mission;
  perfect.telescope.distortion = {};
  const SkyProjection distorted = make_projection(mission);
  const SkyProjection straight = make_projection(perfect);
  const SkyPosition sky = distorted.to_sky({3100.0, 3000.0});
  StarCatalogue catalogue;
  catalogue.passband = "P";
  CatalogueStar star;
  star.id = "one";
  star.sky = sky;
  star.magnitude = Magnitude(10.0);
  catalogue.stars.push_back(star);
  const Scene scene(mission, catalogue);
  ASSERT_EQ(scene.stars().size(), 1U);
  EXPECT_NEAR(scene.stars()[0].position.x, 3100.0, 2.0 * kPixelGrid);
  EXPECT_NEAR(scene.stars()[0].position.y, 3000.0, 2.0 * kPixelGrid);
  EXPECT_EQ(scene.stars()[0].motion.dx_dyaw, distorted.attitude_jacobian(sky)->dx_dyaw);
  const PixelPosition where = *straight.to_pixel(sky);
  EXPECT_GT(std::hypot(where.x - 3100.0, where.y - 3000.0), 100.0);
}

}  // namespace
}  // namespace astroid
