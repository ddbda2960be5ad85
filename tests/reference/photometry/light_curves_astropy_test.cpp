// Light-curve files read by astropy.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "astroid/photometry/light_curves.hpp"
#include "astroid/test/python.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

std::vector<double> numbers(std::istream& lines) {
  std::string line;
  std::getline(lines, line);
  std::istringstream words(line);
  std::vector<double> values;
  for (double value = 0.0; words >> value;) values.push_back(value);
  return values;
}

TEST(LightCurves, AreReadByAstropyAndFollowTheRulesOfLightkurve) {
  if (!test::python_has({"numpy", "astropy"})) GTEST_SKIP() << "python3-astropy is not installed";
  constexpr std::int64_t kExposures = 3000;
  constexpr std::size_t kStars = 2;
  LightCurveHeader header;
  header.exposures = kExposures;
  header.cameras = 2;
  header.start_mjd = 61406.25;
  header.cycle = 25.0;
  header.exposure_time = 21.0;
  header.history = {"effect photon-noise: on"};
  const std::vector<LightCurveStar> stars{{"first", 10.0, 1.0, 2.0, 371722.881, 1.7e-3, 0},
                                          {"second", 12.0, 3.0, 4.0, 58914.106, 5.2e-3, 8}};
  const auto deviation = [](std::size_t star, std::int64_t k, int camera) {
    return static_cast<float>(1e-3 * std::sin(0.01 * static_cast<double>(k)) * camera +
                              1e-4 * static_cast<double>(star));
  };
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "lightcurves.fits").string();
  LightCurveWriter writer(path, header, stars);
  for (std::int64_t first = 0; first < kExposures; first += 1024) {
    const auto count = static_cast<std::size_t>(std::min<std::int64_t>(1024, kExposures - first));
    for (int camera = 1; camera <= 2; ++camera) {
      std::vector<float> block;
      for (std::size_t star = 0; star < kStars; ++star)
        for (std::size_t k = 0; k < count; ++k)
          block.push_back(deviation(star, first + static_cast<std::int64_t>(k), camera));
      writer.write_block(camera, first, count, block);
    }
  }
  writer.add_flags(std::vector<LightCurveFlag>{{1, 1, 17, 6}});
  writer.commit();
  const std::string single = (folder.path() / "second.fits").string();
  const LightCurve curve = read_light_curve(path, "second", 2);
  export_light_curve(single, curve, header);

  std::istringstream printed(
      test::run_python(test::source_dir() / "tests/reference/photometry/light_curves_astropy.py", {path, single}));
  const auto time = numbers(printed);
  const auto reference = numbers(printed);
  const auto camera2 = numbers(printed);
  const auto mean = numbers(printed);
  const auto flags = numbers(printed);
  const auto start = numbers(printed);
  const auto flux = numbers(printed);
  const auto error = numbers(printed);
  ASSERT_EQ(time.size(), static_cast<std::size_t>(kExposures));
  ASSERT_EQ(camera2.size(), time.size());
  ASSERT_EQ(mean.size(), time.size());
  ASSERT_EQ(flux.size(), time.size());
  EXPECT_EQ(reference, (std::vector<double>{371722.881, 58914.106}));
  EXPECT_EQ(flags, std::vector<double>{6.0});
  ASSERT_EQ(start.size(), 1U);
  EXPECT_NEAR(start[0], 61406.25 + 10.5 / 86400.0, 1e-9);
  for (std::int64_t k = 0; k < kExposures; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_EQ(time[i], mid_exposure_bjd(header, k));
    EXPECT_EQ(camera2[i], static_cast<double>(deviation(1, k, 2)));
    EXPECT_NEAR(mean[i], 0.5 * (static_cast<double>(deviation(1, k, 1)) + static_cast<double>(deviation(1, k, 2))),
                1e-9);
    EXPECT_EQ(flux[i], curve.flux[i]);
    EXPECT_DOUBLE_EQ(error[i], 5.2e-3 * 58914.106);
  }
}

}  // namespace
}  // namespace astroid
