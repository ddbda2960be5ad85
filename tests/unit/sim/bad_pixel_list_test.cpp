#include "astroid/sim/bad_pixel_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/sim/simulator.hpp"
#include "astroid/test/scenes.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

Mission mission_with(const std::string& path) {
  Mission mission = test::bare_mission(20, 30);
  mission.ccd.bad_pixels.file = path;
  return mission;
}

BadPixelList read(const std::string& table, void (*change)(Mission&) = nullptr) {
  const test::TemporaryFolder folder;
  Mission mission = mission_with(folder.write("bad.csv", table).string());
  if (change != nullptr) change(mission);
  return read_bad_pixels(mission);
}

TEST(BadPixelList, HasKindsAndRates) {
  const BadPixelList list = read("x,y,kind,rate_e_per_s\n3,4,dead,\n5,6,hot,20\n7,8,hot,\n9,10,,\n");
  ASSERT_EQ(list.dead.size(), 2U);
  EXPECT_EQ(list.dead[1].x, 9);
  EXPECT_EQ(list.dead[1].y, 10);
  ASSERT_EQ(list.hot.size(), 2U);
  EXPECT_EQ(list.hot[0].current.value(), 20.0);
  EXPECT_EQ(list.hot[1].current.value(), 1000.0);
  EXPECT_EQ(read("3 4\n5 6\n").dead.size(), 2U);
}

TEST(BadPixelList, ColumnsAreDeadBehindTheirDefect) {
  const std::string column = "x,y,kind\n3,20,column\n";
  EXPECT_EQ(read(column).dead.size(), 10U);  // rows 20 to 29, read downwards
  const BadPixelList four = read(column, [](Mission& m) { m.ccd.nodes.count = 4; });
  ASSERT_EQ(four.dead.size(), 6U);  // rows 15 to 20, read upwards
  EXPECT_EQ(four.dead.front().y, 15);
  EXPECT_EQ(four.dead.back().y, 20);
  EXPECT_EQ(read(column, [](Mission& m) { m.simulation.type = DetectorType::kCmos; }).dead.size(), 30U);
}

TEST(BadPixelList, NamesEveryBadLine) {
  try {
    read("x,y,kind,rate_e_per_s\n20,4,dead,\n-1,30,dead,\n1.5,2,dead,\n1,2,warm,\n1,2,hot,-3\n1,x,dead,\n");
    FAIL() << "a bad file was accepted";
  } catch (const InputError& error) {
    const auto& problems = error.problems();
    ASSERT_EQ(problems.size(), 7U);
    EXPECT_EQ(problems[0].line, 2);
    EXPECT_THAT(problems[0].message, HasSubstr("is no pixel of the detector"));
    EXPECT_EQ(problems[0].expected, "a whole number from 0 to 19");
    EXPECT_EQ(problems[2].expected, "a whole number from 0 to 29");
    EXPECT_EQ(problems[4].expected, "dead, hot or column");
    EXPECT_THAT(problems[5].message, HasSubstr("no dark current"));
    EXPECT_EQ(problems[6].line, 7);
  }
}

TEST(BadPixelList, MasksMustBeOfTheDetector) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, int nx, int ny, float odd) {
    const std::string path = (folder.path() / name).string();
    FitsWriter fits(path);
    fits.begin_image(FitsNumber::kFloat32, {nx, ny});
    std::vector<float> mask(static_cast<std::size_t>(nx * ny), 0.0F);
    mask[43] = 1.0F;
    mask[64] = 2.0F;
    mask[5] = odd;
    fits.write_pixels(0, std::span<const float>(mask));
    fits.commit();
    return path;
  };
  const BadPixelList list = read_bad_pixels(mission_with(write("good.fits", 20, 30, 0.0F)));
  ASSERT_EQ(list.dead.size(), 1U);
  EXPECT_EQ(list.dead[0].x, 3);
  EXPECT_EQ(list.dead[0].y, 2);
  ASSERT_EQ(list.hot.size(), 1U);
  EXPECT_EQ(list.hot[0].x, 4);
  EXPECT_EQ(list.hot[0].y, 3);
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      read_bad_pixels(mission_with(path));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(write("small.fits", 20, 10, 0.0F)), HasSubstr("an image of the detector, 20 x 30 px"));
  EXPECT_THAT(refusal(write("odd.fits", 20, 30, 7.0F)), HasSubstr("pixel (5, 0) = 7: is no kind of pixel"));
}

TEST(BadPixelList, IsInTheImageAndItsFlags) {
  const test::TemporaryFolder folder;
  Mission mission = mission_with(
      folder.write("bad.csv", "x,y,kind,rate_e_per_s\n3,4,dead,\n5,6,hot,20\n5,6,hot,1\n9,25,column,\n").string());
  mission.field.sky_background = ElectronsPerSecond(10.0);
  const auto scene = std::make_shared<const Scene>(mission, test::lab_catalogue({{14.0, 15.0, 1e4}}));
  const auto plan = std::make_shared<const Plan>(make_plan(*scene));
  EXPECT_TRUE(plan->runs("dead-pixels") && plan->runs("hot-pixels") && plan->runs("bad-pixel-map"));
  const Simulator simulator(scene, plan, 0);
  ExposureState state = simulator.make_state();
  simulator.simulate(0, state);
  int flagged = 0;
  for (const std::uint8_t flags : state.frame.flags.pixels()) flagged += (flags & pixel_flag::kBad) != 0;
  EXPECT_EQ(flagged, 7);
  simulator.expect(0, state);
  const auto view = std::as_const(state.expected).whole().view(0);
  EXPECT_EQ(view.at(3, 4), 0.0);
  EXPECT_EQ(view.at(9, 27), 0.0);
  EXPECT_EQ(view.at(5, 6) - view.at(0, 0), 21.0 * 21.0);
}

}  // namespace
}  // namespace astroid
