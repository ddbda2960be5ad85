// PSFs integrated over pixels, and exact apertures, against those of photutils.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "astroid/core/psf.hpp"
#include "astroid/photometry/aperture.hpp"
#include "astroid/test/python.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr Rectangle kBox{0, 0, 15, 15};
constexpr double kAccuracy = 1e-6;  // of profiles that are interpolated: of the light in an aperture

/// A stamp that photutils makes too.
struct Case {
  std::string kind;
  PixelPosition centre;
  double size, slope;
};

/// Calls `compare` with each case and its pixels by photutils.
void for_each_stamp(const std::vector<Case>& cases,
                    const std::function<void(const Case&, const std::vector<double>&)>& compare) {
  std::ostringstream lines;
  lines.precision(17);
  for (const Case& c : cases)
    lines << c.kind << ' ' << c.centre.x << ' ' << c.centre.y << ' ' << c.size << ' ' << c.slope << '\n';
  const test::TemporaryFolder folder;
  const auto file = folder.write("cases.txt", lines.str());
  std::istringstream printed(
      test::run_python(test::source_dir() / "tests/reference/photometry/stamps_photutils.py", {file.string()}));
  for (const Case& c : cases) {
    std::vector<double> pixels(kBox.size());
    for (double& pixel : pixels) ASSERT_TRUE(printed >> pixel) << c.kind;
    compare(c, pixels);
  }
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
  return largest;
}

std::vector<double> stamp_of(const PixelPsf& psf, PixelPosition centre) {
  std::vector<double> fractions(kBox.size());
  psf.integrate(centre, kBox, fractions);
  return fractions;
}

class PhotutilsStamps : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::python_has({"numpy", "scipy", "photutils"}))
      GTEST_SKIP() << "python3-photutils or -scipy is not installed";
  }
};

TEST_F(PhotutilsStamps, OfAGaussianAreOurs) {
  std::vector<Case> cases;
  for (const double sigma : {0.3, 0.6, 1.1, 2.5})
    for (int i = 0; i < 5; ++i) cases.push_back({"gaussian", {7.0 + 0.191 * i, 6.7 - 0.233 * i}, sigma, 0.0});
  for_each_stamp(cases, [](const Case& c, const std::vector<double>& theirs) {
    // Differences of erf, each of them good to a few 1e-16.
    EXPECT_LT(largest_difference(stamp_of(*make_gaussian_psf(c.size), c.centre), theirs), 2e-15) << c.size;
  });
}

TEST_F(PhotutilsStamps, OfAMoffatProfileAreOursToTheAccuracyAsked) {
  std::vector<Case> cases;
  for (const double beta : {2.5, 4.765}) cases.push_back({"moffat", {7.137, 6.711}, 1.7, beta});
  for_each_stamp(cases, [](const Case& c, const std::vector<double>& theirs) {
    const double fwhm = 2.0 * c.size * std::sqrt(std::pow(2.0, 1.0 / c.slope) - 1.0);
    const auto psf = make_moffat_psf(fwhm, c.slope, {}, kAccuracy);
    EXPECT_LT(largest_difference(stamp_of(*psf, c.centre), theirs), kAccuracy) << c.slope;
  });
}

TEST_F(PhotutilsStamps, OfExactAperturesAreOurs) {
  std::vector<Case> cases;
  for (const double radius : {0.2, 0.5, 1.0, 2.25, 5.1})
    for (int i = 0; i < 6; ++i) cases.push_back({"circle", {7.0 + 0.173 * i, 7.0 - 0.21 * i}, radius, 0.0});
  for_each_stamp(cases, [](const Case& c, const std::vector<double>& theirs) {
    std::vector<double> ours(kBox.size());
    aperture_overlap(c.centre, c.size, kBox, ours);
    EXPECT_LT(largest_difference(ours, theirs), 1e-13) << c.size << " at " << c.centre.x << ", " << c.centre.y;
  });
}

}  // namespace
}  // namespace astroid
