// Background and apertures against SExtractor's own maps and catalogue of a real frame (ESO NTT/EMMI, 256 × 256 px).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include "astroid/core/fits.hpp"
#include "astroid/photometry/background.hpp"
#include "astroid/photometry/detection.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/test/ground_scene.hpp"
#include "astroid/test/python.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

Image<double, unit::Adu> read_map(const std::filesystem::path& path) {
  const FitsReader reader(path);
  return reader.read_image<double, unit::Adu>(reader.first_image());
}

struct Difference {
  double mean_level = 0.0;    // ADU
  double worst_level = 0.0;   // ADU
  double worst_inside = 0.0;  // ADU, a cell and more from the edge
  double worst_rms = 0.0;     // relative
};

// `level` and `rms` are theirs, row by row.
Difference compare(const BackgroundMap& map, std::span<const double> level, std::span<const double> rms, int cell) {
  Difference d;
  const auto nx = static_cast<std::size_t>(map.area().nx);
  std::vector<double> row(nx);
  for (int y = 0; y < map.area().ny; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * nx;
    map.level_row(y, row);
    for (std::size_t x = 0; x < nx; ++x) {
      const double difference = row[x] - level[first + x];
      d.worst_level = std::max(d.worst_level, std::abs(difference));
      const auto column = static_cast<int>(x);
      const bool inside = std::min({column, y, map.area().nx - 1 - column, map.area().ny - 1 - y}) >= cell;
      if (inside) d.worst_inside = std::max(d.worst_inside, std::abs(difference));
      d.mean_level += difference / static_cast<double>(level.size());
    }
    map.rms_row(y, row);
    for (std::size_t x = 0; x < nx; ++x) d.worst_rms = std::max(d.worst_rms, std::abs(row[x] / rms[first + x] - 1.0));
  }
  std::cout << "level: mean " << d.mean_level << ", worst " << d.worst_level << ", inside " << d.worst_inside
            << " ADU; rms: worst " << d.worst_rms << '\n';
  return d;
}

// Counts of this image are whole multiples of 8.77 ADU.
constexpr double kStep = 8.766;

TEST(BackgroundMap, IsThatOfSextractorToOneStepOfTheCounts) {
  const auto image = test::shared_data("images/sep_image.fits");
  const auto back = test::shared_data("images/sep_back.fits");
  const auto rms = test::shared_data("images/sep_rms.fits");
  if (!image || !back || !rms) GTEST_SKIP() << "the shared images are not here";
  const ImageFile file = read_frame(*image);
  const BackgroundMap map(file.frame, 0, {.cell = 64, .filter = 3, .estimator = SkyEstimator::kMode});
  // As SExtractor does it; SExtractor's median is one of the counts that occur; ours is between them where the
  // histogram says so.
  const Difference d = compare(map, read_map(*back).pixels(), read_map(*rms).pixels(), 64);
  EXPECT_LT(std::abs(d.mean_level), 0.25 * kStep);
  EXPECT_LT(d.worst_level, kStep);
  EXPECT_LT(d.worst_rms, 0.03) << "ours is corrected for the clipped tails, 1.5 %";
}

std::vector<double> read_raw(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<double> values;
  for (float v = 0.0F; file.read(reinterpret_cast<char*>(&v), sizeof v);) values.push_back(static_cast<double>(v));
  return values;
}

TEST(BackgroundMap, IsThatOfSepWithoutQuantisation) {
  const auto image = test::shared_data("images/sep_image.fits");
  if (!image) GTEST_SKIP() << "the shared images are not here";
  if (!test::python_has({"numpy", "sep"})) GTEST_SKIP() << "python3-sep is not installed";
  ImageFile file = read_frame(*image);
  const test::TestNoise noise(12);
  const auto pixels = file.frame.pixels.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] += static_cast<float>(kStep * (noise.uniform(0, static_cast<std::uint32_t>(i)) - 0.5));
  const test::TemporaryFolder folder;
  folder.write("image.raw", std::string(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes()));
  const auto path = [&folder](const char* name) { return (folder.path() / name).string(); };
  (void)test::run_python(test::source_dir() / "tests/reference/photometry/background_sep.py",
                         {path("image.raw"), "256", "256", "32", "3", path("level.raw"), path("rms.raw")});
  const BackgroundMap map(file.frame, 0, {.cell = 32, .filter = 3, .estimator = SkyEstimator::kMode});
  const auto level = read_raw(path("level.raw"));
  const auto rms = read_raw(path("rms.raw"));
  ASSERT_EQ(level.size(), pixels.size());
  // Cells of 1024 pixels of 65 ADU: each knows its mode to 4.3 ADU, so half of that is agreement in method. Where the
  // outer half cells are extrapolated, SExtractor's spline isn't quite the natural one.
  const Difference d = compare(map, level, rms, 32);
  EXPECT_LT(std::abs(d.mean_level), 0.3);
  EXPECT_LT(d.worst_inside, 2.2);
  EXPECT_LT(d.worst_level, 4.3);
  EXPECT_LT(d.worst_rms, 0.03);
}

// Columns of the catalogue, 0-based.
constexpr std::size_t kX = 1;
constexpr std::size_t kFlux = 12;
constexpr std::size_t kError = 13;

std::vector<std::vector<double>> read_catalogue_of_sextractor(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  std::ifstream lines(path);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::vector<double> value;
    for (double v = 0.0; fields >> v;) value.push_back(v);
    if (value.size() > kError) rows.push_back(std::move(value));
  }
  return rows;
}

TEST(DetectStars, FindsTheSourcesOfSextractor) {
  const auto image = test::shared_data("images/sep_image.fits");
  const auto catalogue = test::shared_data("images/sep_image_sextractor.cat");
  if (!image || !catalogue) GTEST_SKIP() << "the shared images are not here";
  const ImageFile file = read_frame(*image);
  const Detection found = detect_stars(file.frame, BackgroundMap(file.frame, 0, {}), {});
  const auto theirs = read_catalogue_of_sextractor(*catalogue);
  ASSERT_GT(theirs.size(), 50U);
  std::size_t near = 0;
  for (const auto& row : theirs)
    near += std::any_of(found.stars.begin(), found.stars.end(), [&](const DetectedStar& star) {
      return std::hypot(star.x - (row[kX] - 1.0), star.y - (row[kX + 1] - 1.0)) < 2.5;
    });
  std::cout << near << " of " << theirs.size() << " sources of SExtractor are among our " << found.stars.size() << '\n';
  // Theirs are barycentres of galaxies too; all have five pixels above 1.5 sigma.
  EXPECT_EQ(near, theirs.size());
}

TEST(AperturePhotometry, MeasuresTheFluxesOfSextractor) {
  const auto image = test::shared_data("images/sep_image.fits");
  const auto back = test::shared_data("images/sep_back.fits");
  const auto catalogue = test::shared_data("images/sep_image_sextractor.cat");
  if (!image || !back || !catalogue) GTEST_SKIP() << "the shared images are not here";
  FrameReadOptions options;
  options.gain = Gain(1.0);
  ImageFile file = read_frame(*image, options);
  const auto level = read_map(*back);
  for (std::size_t i = 0; i < level.size(); ++i) file.frame.pixels.pixels()[i] -= static_cast<float>(level.pixels()[i]);
  std::vector<SourceRequest> requests;
  std::vector<double> their_flux;
  std::vector<double> their_error;
  for (const auto& value : read_catalogue_of_sextractor(*catalogue)) {
    requests.push_back(
        {std::to_string(requests.size()), PixelPosition{value[kX] - 1.0, value[kX + 1] - 1.0}, std::nullopt});
    their_flux.push_back(value[kFlux]);
    their_error.push_back(value[kError]);
  }
  ASSERT_GT(requests.size(), 50U);
  ImagePhotometrySettings settings;
  settings.aperture_radius = Pixels(5.0);          // PHOT_APERTURES 10
  settings.background = BackgroundMethod::kKnown;  // their map was taken out
  const auto measured = measure_image(file.frame, nullptr, requests, settings);
  double worst = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if ((measured[i].flags & 1U) != 0U) continue;  // they mirror what the edge cuts off
    worst = std::max(worst, std::abs(measured[i].flux - their_flux[i]) / their_error[i]);
    ++compared;
  }
  std::cout << compared << " sources, worst difference " << worst << " of SExtractor's error\n";
  EXPECT_GT(compared, 40);
  EXPECT_LT(worst, 0.1) << "they sample rim pixels 5 × 5 times";
}

}  // namespace
}  // namespace astroid
