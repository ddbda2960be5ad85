// The sub-pixel renderer and sensitivity within the pixel, in whole exposures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/scenes.hpp"

namespace astroid {
namespace {

std::vector<test::LabStar> crowd() {
  std::vector<test::LabStar> stars;
  for (int i = 0; i < 40; ++i)
    stars.push_back({std::fmod(1.7 + 23.37 * i, 70.0), std::fmod(3.1 + 11.71 * i, 50.0), 1e4 * std::pow(1.12, i)});
  stars.push_back({-1.2, 20.3, 3e5});  // shines in from outside
  stars.push_back({69.49, 49.49, 1e5});
  return stars;
}

Mission mission_with(Renderer renderer) {
  Mission mission = test::bare_mission(70, 50);
  mission.simulation.renderer = renderer;
  return mission;
}

std::vector<double> expected(const Mission& mission, std::int64_t exposure = 1) {
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(crowd()));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.expect(exposure, state);
  const auto pixels = state.expected.whole().pixels();
  return {pixels.begin(), pixels.end()};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

constexpr double kFaintest = 1e4;

TEST(SubPixelStars, AreWhatTheOtherRenderersMake) {
  const auto analytic = expected(mission_with(Renderer::kAnalytic));
  // Stamps end where a millionth of the faintest target's light is left out.
  EXPECT_LT(largest_difference(expected(mission_with(Renderer::kSubPixel)), analytic), 1e-6 * kFaintest);
  EXPECT_LT(largest_difference(expected(mission_with(Renderer::kPrf)), analytic), 1e-6 * 1e6);
}

TEST(SubPixelStars, FollowEveryTreatmentOfMotion) {
  for (const double rms : {0.05, 0.8, 6.0}) {
    Mission analytic = mission_with(Renderer::kAnalytic);
    analytic.satellite.jitter.model = JitterModel::kRedNoise;
    analytic.satellite.jitter.yaw = analytic.satellite.jitter.pitch = Arcseconds(rms);
    Mission map = analytic;
    map.simulation.renderer = Renderer::kSubPixel;
    EXPECT_LT(largest_difference(expected(map), expected(analytic)), 3e-6 * 1e6) << rms;
  }
}

TEST(SubPixelStars, HaveTheBitsOfTheFullFrameInWindows) {
  Mission full = mission_with(Renderer::kSubPixel);
  full.psf.intra_pixel = {.depth = 0.05, .flat = 0.02};
  Mission part = full;
  part.ccd.has_sub_field = true;
  part.ccd.sub_x0 = 13;
  part.ccd.sub_y0 = 7;
  part.ccd.sub_columns = 31;
  part.ccd.sub_rows = 22;
  const auto whole = expected(full);
  const auto window = expected(part);
  for (int y = 0; y < 22; ++y)
    for (int x = 0; x < 31; ++x)
      EXPECT_EQ(window[static_cast<std::size_t>(y * 31 + x)], whole[static_cast<std::size_t>((y + 7) * 70 + x + 13)]);
}

TEST(IntraPixelResponse, IsTheSameFoldedIntoThePsfAndCellByCell) {
  for (const IntraPixelProfile profile :
       {IntraPixelProfile::kEdge, IntraPixelProfile::kCosine, IntraPixelProfile::kGaussian}) {
    Mission folded = mission_with(Renderer::kAuto);
    folded.psf.intra_pixel = {.profile = profile, .depth = 0.1};
    Mission cells = folded;
    cells.simulation.renderer = Renderer::kSubPixel;
    const Scene scene(folded, test::lab_catalogue(crowd()));
    EXPECT_EQ(make_plan(scene).renderer, "prf");
    const auto a = expected(folded);
    const auto b = expected(cells);
    EXPECT_LT(largest_difference(a, b), 1e-6 * 1e6);
    Mission none = folded;
    none.psf.intra_pixel.depth = 0.0;
    EXPECT_GT(largest_difference(a, expected(none)), 1e-3 * 1e5);
  }
}

TEST(IntraPixelResponse, ThatDiffersFromPixelToPixelKeepsEachPixelAsAWhole) {
  Mission mission = mission_with(Renderer::kAuto);
  mission.psf.intra_pixel = {.flat = 0.05};
  mission.psf.sigma = Pixels(6.0);  // nearly uniform light within a pixel
  const Scene scene(mission, test::lab_catalogue(crowd()));
  EXPECT_EQ(make_plan(scene).renderer, "subpixel");
  Mission none = mission;
  none.psf.intra_pixel.flat = 0.0;
  none.simulation.renderer = Renderer::kSubPixel;
  const auto with = expected(mission);
  const auto without = expected(none);
  // What is left is the gradient of the light times the displacement of the pixel's centre of sensitivity, along each
  // axis flat sqrt((1 - 1/cells²) / 12) / cells. Where the light has its peaks the next order is larger.
  const double shift = 0.05 * std::sqrt((1.0 - 0.01) / 12.0) / 10.0;
  constexpr double kSteep = 0.05;  // 1/px, relative
  double squares = 0.0;
  double largest = 0.0;
  double n = 0.0;
  for (int y = 1; y < 49; ++y)
    for (int x = 1; x < 69; ++x) {
      const auto i = static_cast<std::size_t>(y * 70 + x);
      const double gx = 0.5 * (without[i + 1] - without[i - 1]);
      const double gy = 0.5 * (without[i + 70] - without[i - 70]);
      if (std::hypot(gx, gy) < kSteep * without[i]) continue;
      const double z = (with[i] - without[i]) / (shift * std::hypot(gx, gy));
      squares += z * z;
      largest = std::max(largest, std::abs(z));
      n += 1.0;
    }
  const double z_rms = (std::sqrt(squares / n) - 1.0) * std::sqrt(2.0 * n);
  std::printf("%.0f pixels: z of the rms %.2f, largest change %.2f sigma\n", n, z_rms, largest);
  EXPECT_LT(std::abs(z_rms), 4.0);
  EXPECT_LT(largest, 6.0);
}

TEST(IntraPixelResponse, ScattersFluxesAsTheCellsUnderAStarSay) {
  // A narrow star sees few cells: its flux scatters by flat / sqrt(cells it covers).
  Mission mission = test::bare_mission(200, 200);
  mission.psf.sigma = Pixels(0.15);
  mission.psf.intra_pixel = {.cells = 8, .flat = 0.02};
  std::vector<test::LabStar> stars;
  for (int y = 0; y < 19; ++y)
    for (int x = 0; x < 19; ++x) stars.push_back({10.0 + 10.0 * x, 10.0 + 10.0 * y, 1e5});
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue(stars));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  ASSERT_EQ(plan->renderer, "subpixel");
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.expect(0, state);
  double sum = 0.0;
  double squares = 0.0;
  for (const test::LabStar& star : stars) {
    double flux = 0.0;
    const auto view = state.expected.whole().view(0);
    for (int y = -3; y <= 3; ++y)
      for (int x = -3; x <= 3; ++x) flux += view.at(static_cast<int>(star.x) + x, static_cast<int>(star.y) + y);
    const double change = flux / star.electrons - 1.0;
    sum += change;
    squares += change * change;
  }
  // Variance flat² (sum of the squares of the light in each cell - 1/64), a pixel's own mean being taken out.
  const auto erf_cell = [](int i) {
    const double scale = 1.0 / (std::sqrt(2.0) * 0.15 * 8.0);
    return 0.5 * (std::erf((i + 1) * scale) - std::erf(i * scale));
  };
  double axis = 0.0;
  for (int i = -4; i < 4; ++i) axis += erf_cell(i) * erf_cell(i);
  const double sigma = 0.02 * std::sqrt(axis * axis - 1.0 / 64.0);
  const auto n = static_cast<double>(stars.size());
  const double z_mean = sum / n / (sigma / std::sqrt(n));
  const double z_rms = (std::sqrt(squares / n) / sigma - 1.0) * std::sqrt(2.0 * n);
  std::printf("z of the mean %.2f, of the rms %.2f\n", z_mean, z_rms);
  EXPECT_LT(std::abs(z_mean), 4.0);
  EXPECT_LT(std::abs(z_rms), 4.0);
}

TEST(Renderer, IsRefusedWhereItCannotMakeWhatIsAsked) {
  const auto scene = [](const Mission& mission) { const Scene s(mission, test::lab_catalogue(crowd())); };
  Mission response = mission_with(Renderer::kAnalytic);
  response.psf.intra_pixel.depth = 0.1;
  EXPECT_THROW(scene(response), InputError);
  Mission flat = mission_with(Renderer::kPrf);
  flat.psf.intra_pixel.flat = 0.1;
  EXPECT_THROW(scene(flat), InputError);
  Mission narrow = mission_with(Renderer::kSubPixel);
  narrow.psf.sigma = Pixels(0.01);
  EXPECT_THROW(scene(narrow), InputError);
}

TEST(Renderer, IsExplainedByThePlan) {
  const Scene scene(mission_with(Renderer::kSubPixel), test::lab_catalogue(crowd()));
  const Plan plan = make_plan(scene);
  EXPECT_TRUE(plan.runs("sub-pixel-stars"));
  EXPECT_FALSE(plan.runs("stars"));
  EXPECT_LT(plan.renderer_error, 0.4e-6);
  EXPECT_GT(plan.seconds_per_exposure, 0.0);
  const std::string text = to_text(plan, scene);
  EXPECT_NE(text.find("renderer subpixel: the configuration says so"), std::string::npos) << text;
  EXPECT_NE(text.find("sub-pixels per pixel"), std::string::npos) << text;
}

}  // namespace
}  // namespace astroid
