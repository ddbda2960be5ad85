// Circular aperture sums against those of sep, the SExtractor library, with exact overlap.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "astroid/photometry/aperture.hpp"
#include "astroid/test/python.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

TEST(AperturePhotometry, SumsLikeSep) {
  if (!test::python_has({"numpy", "sep"})) GTEST_SKIP() << "python3-sep is not installed";
  constexpr int kColumns = 40;
  constexpr int kRows = 30;
  std::vector<double> image;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) image.push_back(100.0 + 37.0 * std::sin(1.7 * x) * std::cos(2.3 * y) + 0.5 * x);
  const test::TemporaryFolder folder;
  std::string raw(reinterpret_cast<const char*>(image.data()), image.size() * sizeof(double));
  folder.write("image.raw", raw);

  struct Circle {
    PixelPosition centre;
    double radius;
  };
  std::vector<Circle> circles;
  std::ostringstream lines;
  lines.precision(17);
  for (const double radius : {0.15, 0.4, 0.5, 0.8, 1.0, 1.5, 2.25, 4.0, 7.3}) {
    // Sep 1.2.1 takes a pixel for wholly inside when a smaller circle is centred on it exactly, so no centre is there.
    for (int i = 1; i < 9; ++i) {
      circles.push_back({{14.0 + 0.731 * i, 13.0 + 0.317 * i}, radius});
      lines << circles.back().centre.x << ' ' << circles.back().centre.y << ' ' << radius << '\n';
    }
  }
  const auto apertures = folder.write("apertures.txt", lines.str());
  std::istringstream printed(test::run_python(
      test::source_dir() / "tests/reference/photometry/aperture_sep.py",
      {(folder.path() / "image.raw").string(), std::to_string(kColumns), std::to_string(kRows), apertures.string()}));
  for (const Circle& circle : circles) {
    double expected = 0.0;
    ASSERT_TRUE(printed >> expected);
    const Rectangle box = aperture_box(circle.centre, circle.radius);
    std::vector<double> overlap(box.size());
    aperture_overlap(circle.centre, circle.radius, box, overlap);
    double sum = 0.0;
    for (std::size_t i = 0; i < overlap.size(); ++i) {
      const int x = box.x0 + static_cast<int>(i) % box.nx;
      const int y = box.y0 + static_cast<int>(i) / box.nx;
      if (x >= 0 && x < kColumns && y >= 0 && y < kRows)
        sum += overlap[i] * image[static_cast<std::size_t>(y) * kColumns + static_cast<std::size_t>(x)];
    }
    EXPECT_NEAR(sum / expected, 1.0, 1e-5) << circle.radius << " at " << circle.centre.x << ", " << circle.centre.y;
  }
}

}  // namespace
}  // namespace astroid
