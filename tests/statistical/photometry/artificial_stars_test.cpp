// Stars that are added to an image and looked for: what comes back, and how right it is.
#include "astroid/photometry/artificial_stars.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"
#include "astroid/photometry/field_photometry.hpp"
#include "astroid/test/star_field.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

ArtificialStarSettings settings_of(std::size_t stars) {
  ArtificialStarSettings settings;
  settings.stars = stars;
  // Alone a star of 36 e- has one sigma.
  settings.faintest = 60.0;
  settings.brightest = 10000.0;
  settings.spacing = 16.0;
  return settings;
}

TEST(ArtificialStars, ComeBackAsStarsOfTheImageDo) {
  // As crowded as 15,000 stars on 1024² px.
  const test::StarField field = test::make_star_field({.nx = 300, .ny = 300, .stars = 1290, .slope = 0.25, .seed = 6});
  const auto psf = make_gaussian_psf(2.5 / kFwhmPerSigma);
  const auto measure = [&](const Frame& frame) { return measure_field(frame, nullptr, *psf, {}); };
  const std::vector<CompletenessBin> bins = add_artificial_stars(field.frame, *psf, settings_of(1000), measure);
  std::size_t added = 0;
  std::size_t bright = 0;
  double width = 0.0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const CompletenessBin& bin = bins[i];
    added += bin.added;
    EXPECT_LE(bin.found, bin.added);
    if (i > 0) {
      EXPECT_DOUBLE_EQ(bin.brightest, bins[i - 1].faintest);
    }
    if (bin.faintest < 400.0) continue;  // ten sigma
    // At this density five per cent of places are within half a FWHM of a star as bright.
    EXPECT_GT(bin.completeness(), 0.93 - 3.0 * bin.completeness_error()) << bin.faintest;
    EXPECT_NEAR(bin.magnitude_error, 0.0, 0.01 + 4.0 * bin.magnitude_scatter / std::sqrt(bin.found)) << bin.faintest;
    width += bin.pull_width * static_cast<double>(bin.found);
    bright += bin.found;
  }
  EXPECT_EQ(added, 1000U);
  EXPECT_NEAR(width / static_cast<double>(bright), 1.0, 0.1 + 2.0 * 1.17 / std::sqrt(static_cast<double>(bright)));
  // The threshold is five sigma, so two sigma hardly ever make a star.
  EXPECT_LT(bins.back().completeness(), 0.1);
  const double limit = completeness_limit(bins, 0.5);
  EXPECT_GT(limit, 100.0);
  EXPECT_LT(limit, 400.0);
}

TEST(ArtificialStars, AreTheSameAgainAndKeepTheirDistance) {
  const test::StarField field = test::make_star_field({.nx = 128, .ny = 96, .stars = 20, .slope = 0.1, .seed = 7});
  const auto psf = make_gaussian_psf(1.0);
  std::vector<float> first;
  const auto nothing = [&](const Frame& frame) {
    first.assign(frame.pixels.pixels().begin(), frame.pixels.pixels().end());
    return std::vector<SourceMeasurement>{};
  };
  const ArtificialStarSettings settings = settings_of(15);
  const auto bins = add_artificial_stars(field.frame, *psf, settings, nothing);
  const std::vector<float> once = first;
  (void)add_artificial_stars(field.frame, *psf, settings, nothing);
  EXPECT_EQ(first, once);
  std::size_t added = 0;
  for (const CompletenessBin& bin : bins) {
    added += bin.added;
    EXPECT_EQ(bin.found, 0U);
    EXPECT_TRUE(std::isnan(bin.magnitude_error));
  }
  EXPECT_EQ(added, 15U);
  EXPECT_TRUE(std::isnan(completeness_limit(bins, 0.5)));
  // The image itself is as it was, and only light was added.
  const auto original = field.frame.pixels.pixels();
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_GE(once[k], original[k]);
}

TEST(ArtificialStars, HaveALimitBetweenTheMiddlesOfBins) {
  std::vector<CompletenessBin> bins(3);
  const double edges[] = {1600.0, 400.0, 100.0, 25.0};
  for (std::size_t i = 0; i < 3; ++i) {
    bins[i].brightest = edges[i];
    bins[i].faintest = edges[i + 1];
    bins[i].added = 100;
  }
  bins[0].found = 100;
  bins[1].found = 75;
  bins[2].found = 25;
  EXPECT_NEAR(completeness_limit(bins, 0.5), 100.0, 1e-9);
  bins[2].found = 60;
  EXPECT_TRUE(std::isnan(completeness_limit(bins, 0.5)));
}

TEST(ArtificialStars, AreWrittenWithMagnitudes) {
  const test::TemporaryFolder folder;
  std::vector<CompletenessBin> bins(1);
  bins[0].brightest = 1e4;
  bins[0].faintest = 1e3;
  bins[0].added = 10;
  bins[0].found = 9;
  const auto file = folder.path() / "completeness.csv";
  write_completeness(file, bins, Magnitude(25.0), Seconds(10.0));
  std::ifstream in(file);
  std::string header;
  std::string row;
  std::getline(in, header);
  std::getline(in, row);
  EXPECT_EQ(header,
            "mag_bright,mag_faint,added,found,completeness,completeness_err,mag_error,mag_scatter,pull,pull_width");
  EXPECT_EQ(row.substr(0, 35), "17.5000,20.0000,10,9,0.9000,0.1034,");
}

TEST(ArtificialStars, NeedARangeOfFluxes) {
  const test::StarField field = test::make_star_field({.nx = 32, .ny = 32, .stars = 1});
  const auto psf = make_gaussian_psf(1.0);
  const auto nothing = [](const Frame&) { return std::vector<SourceMeasurement>{}; };
  EXPECT_THROW((void)add_artificial_stars(field.frame, *psf, {}, nothing), InputError);
  ArtificialStarSettings settings = settings_of(0);
  EXPECT_THROW((void)add_artificial_stars(field.frame, *psf, settings, nothing), InputError);
  settings = settings_of(5);
  settings.brightest = settings.faintest;
  EXPECT_THROW((void)add_artificial_stars(field.frame, *psf, settings, nothing), InputError);
}

}  // namespace
}  // namespace astroid
