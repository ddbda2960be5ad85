#include "astroid/photometry/light_curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/fits_reader.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LightCurveHeader header_of(std::int64_t exposures, int cameras) {
  LightCurveHeader header;
  header.exposures = exposures;
  header.cameras = cameras;
  header.start_mjd = 61406.0;
  header.cycle = 25.0;
  header.exposure_time = 21.0;
  header.history = {"effect photon-noise: on", "renderer: analytic"};
  return header;
}

std::vector<LightCurveStar> three_stars() {
  return {{"Gaia DR3 1", 10.5, 1.25, 2.5, 3.5e5, 1.7e-3, 0},
          {"x", 12.0, 100.0, 7.0, 5.9e4, 5.2e-3, 8},
          {"tenth", 15.0, -0.25, 0.0, 1234.5678901234567, 0.1, 0}};
}

// Deviation of star s in exposure k of camera c; exact in a float.
float deviation(std::size_t star, std::int64_t k, int camera) {
  return static_cast<float>(static_cast<double>(star + 1) * 0x1p-10 + static_cast<double>(k) * 0x1p-20 +
                            camera * 0x1p-12);
}

void write(LightCurveWriter& writer, int camera, std::int64_t first, std::size_t count) {
  std::vector<float> block;
  for (std::size_t star = 0; star < 3; ++star)
    for (std::size_t k = 0; k < count; ++k)
      block.push_back(deviation(star, first + static_cast<std::int64_t>(k), camera));
  writer.write_block(camera, first, count, block);
}

TEST(LightCurveTime, DoesNotDriftOverYears) {
  LightCurveHeader header = header_of(6000000, 1);
  header.cycle = 25.1;
  for (const std::int64_t k : {std::int64_t{0}, std::int64_t{1}, std::int64_t{5680000}}) {
    const long double expected = 25.1L * static_cast<long double>(k) + 10.5L;
    EXPECT_NEAR(static_cast<double>(mid_exposure(header, k) - expected), 0.0, 1e-7);
    const long double days = (61406.0L - 56999.5L) + expected / 86400.0L;
    EXPECT_NEAR(static_cast<double>(mid_exposure_bjd(header, k) - days) * 86400.0, 0.0, 1e-7);
  }
}

TEST(LightCurves, OfGroupsHaveTheStarsAndTheTimesOfEachCamera) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  auto second = three_stars();
  for (LightCurveStar& star : second) {
    star.x += 10.0;
    star.reference *= 0.5;
  }
  LightCurveHeader header = header_of(4, 2);
  header.group = {0, 1};
  header.stagger = {0.0, 12.5};
  LightCurveWriter writer(path, header, three_stars(), {three_stars(), second});
  write(writer, 1, 0, 4);
  write(writer, 2, 0, 4);
  writer.commit();
  const LightCurveReader reader(path);
  EXPECT_EQ(reader.contents().header.group, header.group);
  EXPECT_EQ(reader.contents().header.stagger, header.stagger);
  const LightCurve one = reader.read("x", 1);
  const LightCurve two = reader.read("x", 2);
  const LightCurve mean = reader.read("x", 0);
  EXPECT_EQ(two.star.x, one.star.x + 10.0);
  EXPECT_EQ(two.flux[3], second[1].reference * (1.0 + static_cast<double>(deviation(1, 3, 2))));
  EXPECT_EQ(one.time[1], 25.0 + 10.5);
  EXPECT_EQ(two.time[1], 25.0 + 10.5 + 12.5);
  EXPECT_EQ(mean.time[1], 25.0 + 10.5 + 6.25);
}

TEST(LightCurves, ReadBackWhatWasWrittenInBlocks) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  const auto stars = three_stars();
  {
    LightCurveWriter writer(path, header_of(10, 1), stars);
    write(writer, 1, 4, 4);
    write(writer, 1, 0, 4);
    write(writer, 1, 8, 2);
    writer.add_flags(std::vector<LightCurveFlag>{{1, 1, 9, 2}, {1, 0, 3, 4}});
    EXPECT_FALSE(std::filesystem::exists(path)) << "written beside until commit";
    writer.commit();
  }
  const LightCurveContents contents = read_light_curve_contents(path);
  ASSERT_EQ(contents.stars.size(), 3U);
  EXPECT_EQ(contents.stars[0].id, "Gaia DR3 1");
  EXPECT_EQ(contents.stars[2].reference, stars[2].reference);
  EXPECT_EQ(contents.header.exposures, 10);
  EXPECT_EQ(contents.header.start_mjd, 61406.0);
  EXPECT_EQ(contents.header.history, header_of(1, 1).history);
  for (std::size_t s = 0; s < 3; ++s) {
    const LightCurve curve = read_light_curve(path, stars[s].id, 1);
    ASSERT_EQ(curve.flux.size(), 10U);
    for (std::int64_t k = 0; k < 10; ++k) {
      const auto i = static_cast<std::size_t>(k);
      EXPECT_EQ(curve.flux[i], stars[s].reference * (1.0 + static_cast<double>(deviation(s, k, 1))));
      EXPECT_EQ(curve.time[i], static_cast<double>(k) * 25.0 + 10.5);
      const std::uint32_t expected = stars[s].flags | (s == 1 && k == 9 ? 2U : 0U) | (s == 0 && k == 3 ? 4U : 0U);
      EXPECT_EQ(curve.flags[i], expected);
    }
  }
  EXPECT_EQ(read_light_curve(path, "x", 0).flux, read_light_curve(path, "x", 1).flux) << "one camera is its own mean";
}

TEST(LightCurves, AverageTheCamerasThatMeasured) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  LightCurveWriter writer(path, header_of(4, 3), three_stars());
  for (const std::int64_t first : {std::int64_t{0}, std::int64_t{2}})
    for (int camera = 1; camera <= 3; ++camera) {
      std::vector<float> block;
      for (std::size_t star = 0; star < 3; ++star)
        for (std::int64_t k = first; k < first + 2; ++k)
          block.push_back((star == 0 && camera == 2) || (star == 2 && k == 3) ? kNan : deviation(star, k, camera));
      writer.write_block(camera, first, 2, block);
    }
  writer.add_flags(std::vector<LightCurveFlag>{{2, 0, 1, 4}, {3, 0, 1, 2}});
  writer.commit();
  const LightCurve mean = read_light_curve(path, "x", 0);
  for (std::int64_t k = 0; k < 4; ++k)
    EXPECT_NEAR(mean.flux[static_cast<std::size_t>(k)] / mean.star.reference - 1.0, deviation(1, k, 2), 1e-9);
  const LightCurve two = read_light_curve(path, "Gaia DR3 1", 0);
  for (std::int64_t k = 0; k < 4; ++k)
    EXPECT_NEAR(two.flux[static_cast<std::size_t>(k)] / two.star.reference - 1.0, deviation(0, k, 2), 1e-9)
        << "the mean of cameras 1 and 3";
  EXPECT_EQ(two.flags[1], 6U) << "flags of all cameras";
  EXPECT_TRUE(std::isnan(read_light_curve(path, "tenth", 0).flux[3]));
  EXPECT_TRUE(std::isnan(read_light_curve(path, "Gaia DR3 1", 2).flux[0]));
  EXPECT_EQ(read_light_curve(path, "Gaia DR3 1", 3).flags[1], 2U);
}

TEST(LightCurves, FindTheFlagsOfAStarAmongMany) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  constexpr int kCameras = 3;
  constexpr std::int64_t kExposures = 40;
  LightCurveWriter writer(path, header_of(kExposures, kCameras), three_stars());
  for (int camera = 1; camera <= kCameras; ++camera) write(writer, camera, 0, kExposures);
  const auto flag = [](int camera, std::size_t star, std::int64_t k) -> std::uint32_t {
    if (star == 1 && camera == 2) return 0;  // this star has none in this camera
    return (k * 7 + camera * 5 + static_cast<std::int64_t>(star)) % 3 == 0 ? 1U << static_cast<unsigned>(camera) : 0U;
  };
  std::vector<LightCurveFlag> flags;
  for (std::int64_t k = 0; k < kExposures; ++k)
    for (std::size_t star = 0; star < 3; ++star)
      for (int camera = 1; camera <= kCameras; ++camera)
        if (flag(camera, star, k) != 0)
          flags.push_back(
              {static_cast<std::uint32_t>(camera), static_cast<std::uint32_t>(star), k, flag(camera, star, k)});
  writer.add_flags(flags);
  writer.commit();
  const LightCurveReader reader(path);
  for (std::size_t star = 0; star < 3; ++star) {
    const std::uint32_t always = reader.contents().stars[star].flags;
    const LightCurve all = reader.read(star, 0);
    for (std::int64_t k = 0; k < kExposures; ++k) {
      const auto i = static_cast<std::size_t>(k);
      std::uint32_t together = always;
      for (int camera = 1; camera <= kCameras; ++camera) {
        EXPECT_EQ(reader.read(star, camera).flags[i], always | flag(camera, star, k));
        together |= flag(camera, star, k);
      }
      EXPECT_EQ(all.flags[i], together);
    }
  }
  EXPECT_THROW((void)reader.read(3, 1), InputError);
  EXPECT_THROW((void)reader.read("x", 4), InputError);
}

TEST(LightCurves, HaveTheSamePixelsWhenThreadsWriteTheStars) {
  const test::TemporaryFolder folder;
  const std::string whole_path = (folder.path() / "whole.fits").string();
  const std::string path = (folder.path() / "threads.fits").string();
  LightCurveWriter whole(whole_path, header_of(7, 2), three_stars());
  LightCurveWriter by_star(path, header_of(7, 2), three_stars());
  for (const auto& [first, count] : {std::pair{std::int64_t{0}, std::size_t{4}}, {4, 3}})
    for (int camera = 1; camera <= 2; ++camera) {
      write(whole, camera, first, count);
      by_star.begin_block(camera, first, count);
      std::vector<std::jthread> threads;
      for (std::size_t star = 0; star < 3; ++star)
        threads.emplace_back([&, star, first = first, count = count] {
          std::vector<float> series;
          for (std::size_t k = 0; k < count; ++k)
            series.push_back(deviation(star, first + static_cast<std::int64_t>(k), camera));
          by_star.write_star(star, series);
        });
      threads.clear();
      by_star.end_block();
    }
  whole.commit();
  by_star.commit();
  for (const LightCurveStar& star : three_stars())
    for (const int camera : {0, 1, 2})
      EXPECT_EQ(read_light_curve(path, star.id, camera).flux, read_light_curve(whole_path, star.id, camera).flux);
}

TEST(LightCurves, JoinFlagsThatFollowOneAnother) {
  // camera, star, exposure, flags, exposures
  std::vector<LightCurveFlag> flags{{1, 1, 8, 2, 2},  {1, 1, 3, 2, 5}, {1, 1, 10, 4}, {2, 1, 11, 4},
                                    {1, 1, 12, 4, 3}, {1, 0, 2, 2},    {1, 1, 2, 2}};
  join_flags(flags);
  const auto fields = [](const LightCurveFlag& f) {
    return std::tuple(f.camera, f.star, f.exposure, f.flags, f.exposures);
  };
  ASSERT_EQ(flags.size(), 5U);
  EXPECT_EQ(fields(flags[0]), std::tuple(1U, 0U, 2, 2U, 1));
  EXPECT_EQ(fields(flags[1]), std::tuple(1U, 1U, 2, 2U, 8));
  EXPECT_EQ(fields(flags[2]), std::tuple(1U, 1U, 10, 4U, 1));
  EXPECT_EQ(fields(flags[3]), std::tuple(1U, 1U, 12, 4U, 3));
  EXPECT_EQ(fields(flags[4]), std::tuple(2U, 1U, 11, 4U, 1));
}

TEST(LightCurves, ReadBackFlagsOfExposuresInARow) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  LightCurveWriter writer(path, header_of(6, 1), three_stars());
  write(writer, 1, 0, 6);
  writer.add_flags(std::vector<LightCurveFlag>{{1, 1, 3, 2, 2}, {1, 1, 1, 2, 2}, {1, 2, 5, 4}});
  writer.commit();
  EXPECT_EQ(read_light_curve(path, "x", 1).flags, (std::vector<std::uint32_t>{8, 10, 10, 10, 10, 8}));
  EXPECT_EQ(read_light_curve(path, "tenth", 1).flags, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 4}));
}

TEST(LightCurves, LeaveNothingBehindWithoutCommit) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  {
    LightCurveWriter writer(path, header_of(4, 1), three_stars());
    write(writer, 1, 0, 4);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(LightCurves, RefuseToCommitWhatIsIncomplete) {
  const test::TemporaryFolder folder;
  LightCurveWriter writer((folder.path() / "lightcurves.fits").string(), header_of(4, 1), three_stars());
  write(writer, 1, 0, 3);
  EXPECT_THROW(writer.commit(), BugError);
}

TEST(LightCurves, RefuseBlocksThatDoNotFit) {
  const test::TemporaryFolder folder;
  LightCurveWriter writer((folder.path() / "lightcurves.fits").string(), header_of(4, 2), three_stars());
  const std::vector<float> block(6, 0.0F);
  EXPECT_THROW(writer.write_block(3, 0, 2, block), BugError);
  EXPECT_THROW(writer.write_block(1, 3, 2, block), BugError);
  EXPECT_THROW(writer.write_block(1, 0, 1, block), BugError);
  EXPECT_THROW(writer.write_block(2, 0, 2, block), BugError) << "camera 1 of the block comes first";
  EXPECT_THROW(writer.write_star(0, std::span(block).first(2)), BugError) << "no block was begun";
  writer.begin_block(1, 0, 2);
  EXPECT_THROW(writer.begin_block(1, 2, 2), BugError) << "the first block has not ended";
  EXPECT_THROW(writer.write_star(3, std::span(block).first(2)), BugError);
  EXPECT_THROW(writer.write_star(0, std::span(block).first(3)), BugError);
  writer.write_star(0, std::span(block).first(2));
  EXPECT_THROW(writer.end_block(), BugError) << "two stars are missing";
}

TEST(LightCurves, CanBeEmpty) {
  const test::TemporaryFolder folder;
  const std::string no_stars = (folder.path() / "a.fits").string();
  LightCurveWriter first(no_stars, header_of(4, 2), {});
  first.write_block(1, 0, 4, {});
  first.write_block(2, 0, 4, {});
  first.commit();
  EXPECT_TRUE(read_light_curve_contents(no_stars).stars.empty());
  const std::string no_exposures = (folder.path() / "b.fits").string();
  LightCurveWriter second(no_exposures, header_of(0, 1), three_stars());
  second.commit();
  EXPECT_TRUE(read_light_curve(no_exposures, "x", 1).flux.empty());
}

TEST(LightCurves, OfARollingShutterHaveTheTimeOfTheRow) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  LightCurveHeader header = header_of(2, 1);
  header.line_time = 0.25;
  LightCurveWriter writer(path, header, three_stars());
  write(writer, 1, 0, 2);
  writer.commit();
  const LightCurveHeader read = read_light_curve_contents(path).header;
  EXPECT_EQ(read.line_time, 0.25);
  const std::string one = (folder.path() / "one.fits").string();
  export_light_curve(one, read_light_curve(path, "Gaia DR3 1", 1), read);
  const FitsReader fits(one);
  const std::vector<double> time = fits.read_numbers(2, 0);
  ASSERT_EQ(time.size(), 2U);
  for (std::int64_t k = 0; k < 2; ++k)  // the star is at y = 2.5
    EXPECT_NEAR((time[static_cast<std::size_t>(k)] - mid_exposure_bjd(header, k)) * 86400.0, 0.625, 1e-6);
}

TEST(LightCurves, SayWhatIsWrongWithARequest) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  LightCurveWriter writer(path, header_of(2, 1), three_stars());
  write(writer, 1, 0, 2);
  writer.commit();
  EXPECT_THROW((void)read_light_curve(path, "nobody", 1), InputError);
  EXPECT_THROW((void)read_light_curve(path, "x", 2), InputError);
  EXPECT_THROW((void)read_light_curve(folder.write("text.fits", "not FITS").string(), "x", 1), InputError);
  EXPECT_THROW((void)read_light_curve((folder.path() / "absent.fits").string(), "x", 1), EnvironmentError);
  const std::string other = (folder.path() / "one.fits").string();
  export_light_curve(other, read_light_curve(path, "x", 1), header_of(2, 1));
  EXPECT_THROW((void)read_light_curve(other, "x", 1), InputError) << "FITS, but not of this kind";
}

}  // namespace
}  // namespace astroid
