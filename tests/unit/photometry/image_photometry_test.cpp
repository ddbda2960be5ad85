#include "astroid/photometry/image_photometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"
#include "astroid/test/ground_scene.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

test::GroundScene three_stars() {
  test::GroundScene scene;
  scene.psf = make_gaussian_psf(1.1);
  scene.noise.background = 800.0;
  scene.gain = Gain(2.0);
  scene.bias = Adu(100.0);
  scene.add_target({20.3, 20.8}, 2e5);
  scene.add_target({60.0, 25.5}, 5e4);
  scene.add_target({40.7, 60.2}, 8e3);
  return scene;
}

Frame clean_frame(const test::GroundScene& scene) {
  const auto layout = test::full_frame(81, 81);
  return test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
}

std::vector<SourceRequest> requests_of(const test::GroundScene& scene) {
  std::vector<SourceRequest> requests;
  for (const FieldStar& star : scene.stars) requests.push_back({star.id, star.position, std::nullopt});
  return requests;
}

TEST(ImagePhotometry, RecoversTheFluxOfTheWholeStarByEveryMethod) {
  const test::GroundScene scene = three_stars();
  const Frame frame = clean_frame(scene);
  for (const PhotometryMethod method :
       {PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted, PhotometryMethod::kPsf}) {
    for (const BackgroundMethod background :
         {BackgroundMethod::kKnown, BackgroundMethod::kLocal, BackgroundMethod::kMesh}) {
      ImagePhotometrySettings settings;
      settings.method = method;
      settings.background = background;
      settings.known_background = Adu(500.0);
      settings.annulus_inner = Pixels(7.0);
      settings.annulus_outer = Pixels(11.0);
      settings.psf = scene.psf;
      settings.mesh.cell = 27;
      const auto measured = measure_image(frame, nullptr, requests_of(scene), settings);
      for (std::size_t i = 0; i < measured.size(); ++i) {
        EXPECT_NEAR(measured[i].flux / scene.stars[i].electrons, 1.0, 2e-3) << i;
        EXPECT_NEAR(measured[i].background, 800.0, 0.5);
        EXPECT_EQ(measured[i].flags, 0U);
        EXPECT_NEAR(measured[i].snr, measured[i].flux / measured[i].flux_err, 1e-9);
        EXPECT_NEAR(measured[i].mag, -2.5 * std::log10(measured[i].flux), 1e-9) << "per second, one second exposed";
        EXPECT_NEAR(measured[i].mag_err, 1.0857362 / measured[i].snr, 1e-6);
        EXPECT_LT(measured[i].chi2, 0.05) << "the frame has no noise";
        EXPECT_TRUE(std::isnan(measured[i].ra));
      }
    }
  }
}

TEST(ImagePhotometry, TellsBlendedStarsApartByPsfWeights) {
  test::GroundScene scene = three_stars();
  const PixelPosition first = scene.stars[0].position;
  scene.add_target({first.x + 2.0, first.y + 0.5}, 5e4);
  ImagePhotometrySettings settings;
  settings.psf = scene.psf;
  settings.annulus_inner = Pixels(8.0);
  settings.annulus_outer = Pixels(12.0);
  settings.mask_window = 8;
  const auto error_of = [&](PhotometryMethod method, std::size_t star) {
    settings.method = method;
    const auto measured = measure_image(clean_frame(scene), nullptr, requests_of(scene), settings);
    const double error = measured[star].flux / scene.stars[star].electrons - 1.0;
    if (method == PhotometryMethod::kPsf) {
      EXPECT_LT(std::abs(measured[star].flux - scene.stars[star].electrons), 2.0 * measured[star].flux_err) << star;
    }
    return std::abs(error);
  };
  for (const std::size_t star : {std::size_t{0}, std::size_t{3}}) {
    EXPECT_LT(error_of(PhotometryMethod::kPsf, star), 0.02) << star;
    EXPECT_GT(error_of(PhotometryMethod::kMask, star), 0.05) << star;
  }
}

TEST(ImagePhotometry, GivesTheSumOfTheApertureWithoutAPsf) {
  const test::GroundScene scene = three_stars();
  ImagePhotometrySettings settings;
  settings.background = BackgroundMethod::kKnown;
  settings.known_background = Adu(500.0);
  settings.aperture_radius = Pixels(4.0);
  const auto measured = measure_image(clean_frame(scene), nullptr, requests_of(scene), settings);
  EXPECT_NEAR(measured[0].flux / 2e5, 1.0 - std::exp(-16.0 / (2 * (1.21 + 1.0 / 6.0))), 2e-3);
  EXPECT_TRUE(std::isnan(measured[0].chi2));
}

TEST(ImagePhotometry, FlagsWhatIsWrongAndMeasuresTheRest) {
  const test::GroundScene scene = three_stars();
  Frame frame = clean_frame(scene);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  frame.pixels.view(0).at(60, 25) = nan;
  frame.flags.view(0).at(60, 25) = pixel_flag::kBad;
  frame.flags.view(0).at(20, 21) = pixel_flag::kAdcSaturated;
  std::vector<SourceRequest> requests = requests_of(scene);
  requests.push_back({"edge", PixelPosition{0.0, 40.0}, std::nullopt});
  requests.push_back({"outside", PixelPosition{-3.0, 40.0}, std::nullopt});
  requests.push_back({"nowhere", PixelPosition{std::numeric_limits<double>::quiet_NaN(), 1.0}, std::nullopt});
  requests.push_back({"unplaced", std::nullopt, std::nullopt});
  for (const PhotometryMethod method :
       {PhotometryMethod::kAperture, PhotometryMethod::kMask, PhotometryMethod::kWeighted, PhotometryMethod::kPsf}) {
    ImagePhotometrySettings settings;
    settings.method = method;
    settings.psf = scene.psf;
    const auto measured = measure_image(frame, nullptr, requests, settings);
    EXPECT_EQ(measured[0].flags & measurement_flag::kSaturated, measurement_flag::kSaturated);
    EXPECT_TRUE(std::isfinite(measured[0].flux));
    EXPECT_NE(measured[1].flags & measurement_flag::kBadPixel, 0U);
    EXPECT_TRUE(std::isnan(measured[1].flux));
    EXPECT_TRUE(std::isnan(measured[1].snr));
    EXPECT_EQ(measured[2].flags, 0U);
    EXPECT_NEAR(measured[2].flux / 8e3, 1.0, 0.05);
    EXPECT_NE(measured[3].flags & measurement_flag::kEdge, 0U);
    for (std::size_t i = 4; i < 7; ++i) {
      EXPECT_EQ(measured[i].flags, measurement_flag::kOutside) << measured[i].id;
      EXPECT_TRUE(std::isnan(measured[i].flux));
    }
  }
}

TEST(ImagePhotometry, MeasuresInTheSmallestImages) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 30}, {30, 1}}) {
    for (const PhotometryMethod method : {PhotometryMethod::kAperture, PhotometryMethod::kMask}) {
      test::GroundScene scene;
      scene.psf = make_gaussian_psf(0.7);
      scene.noise.background = 100.0;
      const auto layout = test::full_frame(nx, ny);
      const Frame frame = test::frame_of(layout, scene, test::expected_electrons(*layout, scene));
      ImagePhotometrySettings settings;
      settings.method = method;
      settings.psf = scene.psf;
      const std::vector<SourceRequest> requests{{"a", PixelPosition{0.0, 0.0}, std::nullopt},
                                                {"b", PixelPosition{50.0, 0.0}, std::nullopt}};
      const auto measured = measure_image(frame, nullptr, requests, settings);
      EXPECT_EQ(measured[1].flags, measurement_flag::kOutside);
      EXPECT_NE(measured[0].flags & measurement_flag::kNoBackground, 0U);
      if (method == PhotometryMethod::kAperture) {
        EXPECT_NEAR(measured[0].flux, 0.0, 1e-6);
      }
    }
  }
}

TEST(ImagePhotometry, RefusesContradictionsAllAtOnce) {
  const test::GroundScene scene = three_stars();
  ImagePhotometrySettings settings;
  settings.method = PhotometryMethod::kMask;
  settings.aperture_radius = Pixels(-1.0);
  settings.annulus_outer = Pixels(1.0);
  try {
    (void)measure_image(clean_frame(scene), nullptr, requests_of(scene), settings);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
  const std::vector<SourceRequest> in_the_sky{{"s", std::nullopt, SkyPosition{10.0, 20.0}}};
  EXPECT_THROW((void)measure_image(clean_frame(scene), nullptr, in_the_sky, {}), InputError);
}

TEST(ImagePhotometry, OfNoSourcesIsAnEmptyTable) {
  const test::TemporaryFolder folder;
  const auto measured = measure_image(clean_frame(three_stars()), nullptr, {}, {});
  EXPECT_TRUE(measured.empty());
  write_sources(folder.path() / "sources.csv", measured);
  EXPECT_EQ(read_text_file(folder.path() / "sources.csv"),
            "id,x,y,ra,dec,flux,flux_err,mag,mag_err,background,snr,chi2,flags\n");
}

TEST(SourceTable, WritesNanAndFlagsAsNumbers) {
  const test::TemporaryFolder folder;
  SourceMeasurement source;
  source.id = "a,b";
  source.x = 1.5;
  source.flux = std::numeric_limits<double>::quiet_NaN();
  source.flags = 33;
  write_sources(folder.path() / "sources.csv", std::vector{source});
  EXPECT_EQ(
      read_text_file(folder.path() / "sources.csv"),
      "id,x,y,ra,dec,flux,flux_err,mag,mag_err,background,snr,chi2,flags\n\"a,b\",1.5,0,0,0,nan,0,0,0,0,0,0,33\n");
}

}  // namespace
}  // namespace astroid
