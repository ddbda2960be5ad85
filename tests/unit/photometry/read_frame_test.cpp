// Keywords of many makes, read from images written here.
#include <gtest/gtest.h>

#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/photometry/image_photometry.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

std::filesystem::path write_float_image(const test::TemporaryFolder& folder, const std::vector<FitsCard>& cards) {
  auto path = folder.path() / "image.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat32, {3, 2});
  writer.cards(cards);
  writer.write_pixels(0, std::vector<float>{1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN(), 4.0F, 70000.0F,
                                            std::numeric_limits<float>::infinity()});
  writer.commit();
  return path;
}

TEST(ReadFrame, TakesTheKeywordsOfOurOwnImages) {
  const test::TemporaryFolder folder;
  const ImageFile file = read_frame(write_float_image(
      folder, {{"GAIN", 25.0}, {"RDNOISE", 50.2}, {"EXPTIME", 21.0}, {"SATURATE", 65535.0}, {"BUNIT", "adu"}}));
  EXPECT_EQ(file.frame.header.gain, Gain(25.0));
  EXPECT_EQ(file.frame.header.readout_noise, Electrons(50.2));
  EXPECT_EQ(file.frame.header.exposure_time, Seconds(21.0));
  EXPECT_TRUE(file.notes.empty());
  EXPECT_FALSE(file.sky.has_value());
  const auto flags = file.frame.flags.view(0);
  EXPECT_EQ(flags.at(0, 0), 0);
  EXPECT_EQ(flags.at(2, 0), pixel_flag::kBad);
  EXPECT_EQ(flags.at(1, 1), pixel_flag::kAdcSaturated);
  EXPECT_EQ(flags.at(2, 1), pixel_flag::kBad);
  EXPECT_EQ(file.frame.pixels.view(0).at(0, 1), 4.0F);
}

TEST(ReadFrame, TakesTheKeywordsOfOthers) {
  const test::TemporaryFolder folder;
  const ImageFile file = read_frame(write_float_image(
      folder, {{"GAIN", 120}, {"EGAIN", 1.5}, {"READNOIS", 9.0}, {"EXPOSURE", 30.0}, {"SATLEVEL", 50000}}));
  EXPECT_EQ(file.frame.header.gain, Gain(1.5)) << "GAIN is a setting of the camera where EGAIN stands beside it";
  EXPECT_EQ(file.frame.header.readout_noise, Electrons(9.0));
  EXPECT_EQ(file.frame.header.exposure_time, Seconds(30.0));
  EXPECT_EQ(file.frame.header.saturation, Adu(50000.0));
}

TEST(ReadFrame, TakesAsBiasOnlyWhatIsCounts) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_frame(write_float_image(folder, {{"BIAS", 200.0, "[adu] bias"}})).frame.header.bias, Adu(200.0));
  const test::TemporaryFolder other;
  EXPECT_EQ(read_frame(write_float_image(other, {{"BIAS", 2.5, "[V] of the gate"}})).frame.header.bias, Adu(0.0));
}

TEST(ReadFrame, KnowsImagesInElectrons) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_frame(write_float_image(folder, {{"BUNIT", "electrons"}, {"GAIN", 3.0}})).frame.header.gain,
            Gain(1.0));
  const test::TemporaryFolder other;
  EXPECT_EQ(read_frame(write_float_image(other, {{"BUNIT", "e-/s"}, {"EXPTIME", 21.0}})).frame.header.gain, Gain(21.0));
}

TEST(ReadFrame, SaysWhatItHadToAssume) {
  const test::TemporaryFolder folder;
  const ImageFile file = read_frame(write_float_image(folder, {{"GAIN", 0.0}, {"RDNOISE", "unknown"}}));
  EXPECT_EQ(file.notes.size(), 3U) << "gain, readout noise and exposure time";
  EXPECT_EQ(file.frame.header.gain, Gain(1.0));
  EXPECT_EQ(file.frame.header.saturation, Adu(std::numeric_limits<double>::infinity()));
}

TEST(ReadFrame, LetsTheUserKnowBetter) {
  const test::TemporaryFolder folder;
  FrameReadOptions options;
  options.gain = Gain(7.0);
  options.readout_noise = Electrons(3.0);
  options.exposure_time = Seconds(2.0);
  options.saturation = Adu(3.5);
  options.bias = Adu(0.5);
  const ImageFile file = read_frame(write_float_image(folder, {{"GAIN", 25.0}}), options);
  EXPECT_EQ(file.frame.header.gain, Gain(7.0));
  EXPECT_EQ(file.frame.header.readout_noise, Electrons(3.0));
  EXPECT_EQ(file.frame.header.bias, Adu(0.5));
  EXPECT_EQ(file.frame.flags.view(0).at(0, 1), pixel_flag::kAdcSaturated);
  options.gain = Gain(0.0);
  options.exposure_time = Seconds(-1.0);
  try {
    (void)read_frame(folder.path() / "image.fits", options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

TEST(ReadFrame, SaturatesIntegerImagesAtTheirLargestNumber) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "image.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned16, {2, 1});
  writer.write_pixels(0, std::vector<std::uint16_t>{65534, 65535});
  writer.commit();
  const ImageFile file = read_frame(path);
  EXPECT_EQ(file.frame.header.saturation, Adu(65535.0));
  EXPECT_EQ(file.frame.flags.view(0).at(0, 0), 0);
  EXPECT_EQ(file.frame.flags.view(0).at(1, 0), pixel_flag::kAdcSaturated);
}

TEST(ReadFrame, ReadsOnePlaneOfACubeWithItsCoordinates) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.fits";
  CameraPointing pointing;
  pointing.axis = {95.0, -47.0};
  pointing.scale = PixelScale(15.0);
  pointing.axis_pixel = {1.0, 0.5};
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned8, {});
  writer.card({"GAIN", 4.0});
  writer.begin_image(FitsNumber::kUnsigned16, {3, 2, 2}, "SCI");
  writer.cards(SkyProjection(pointing).fits_cards());
  writer.write_pixels(0, std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15});
  writer.commit();
  FrameReadOptions options;
  options.plane = 1;
  const ImageFile file = read_frame(path, options);
  EXPECT_EQ(file.frame.pixels.view(0).at(2, 1), 15.0F);
  EXPECT_EQ(file.frame.header.gain, Gain(4.0)) << "from the primary header";
  ASSERT_TRUE(file.sky.has_value());
  EXPECT_NEAR(file.sky->to_pixel({95.0, -47.0})->x, 1.0, 1e-6);
  options.unit = 5;
  EXPECT_THROW((void)read_frame(path, options), InputError);
  options.unit = 2;
  options.plane = 2;
  EXPECT_THROW((void)read_frame(path, options), InputError);
}

/// An image of columns 7 … 9 and rows 20, 21 of a detector of 100 rows, with prescan and overscan beside it.
std::filesystem::path write_with_reference_pixels(const test::TemporaryFolder& folder, int overscan_from) {
  auto path = folder.path() / "reference.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat32, {3, 2});
  writer.cards(std::vector<FitsCard>{
      {"GAIN", 25.0}, {"RDNOISE", 50.0}, {"EXPTIME", 21.0}, {"SATURATE", 65535.0}, {"LTV1", -7}, {"LTV2", -20}});
  writer.write_pixels(0, std::vector<float>{1100.0F, 1200.0F, 1300.0F, 1101.0F, 1201.0F, 1301.0F});
  writer.begin_image(FitsNumber::kFloat32, {2, 2}, "PRESCAN");
  writer.cards(std::vector<FitsCard>{{"LTV1", 2}, {"LTV2", -20}});
  writer.write_pixels(0, std::vector<float>{999.0F, 1001.0F, 998.0F, 1002.0F});
  // One column more on either side, as beside another window.
  writer.begin_image(FitsNumber::kFloat32, {5, 3}, "OVERSCAN");
  writer.cards(std::vector<FitsCard>{{"LTV1", -6}, {"LTV2", -overscan_from}});
  std::vector<float> rows;
  for (int row = -1; row <= 1; ++row)
    for (const float level : {0.0F, 1010.0F, 1020.0F, 1030.0F, 0.0F}) rows.push_back(level + static_cast<float>(row));
  writer.write_pixels(0, rows);
  writer.commit();
  return path;
}

TEST(ReadFrame, SubtractsWhatOverscanRowsShowAndKeepsTheBias) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = write_with_reference_pixels(folder, 100);
  const ImageFile file = read_frame(path);
  const auto pixels = file.frame.pixels.view(0);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 2; ++y)
      EXPECT_NEAR(pixels.at(x, y), 1000.0 + 100.0 * (x + 1) + y - 10.0 * (x + 1), 1e-3) << x << "," << y;
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_EQ(file.notes[0], "The mean of 3 overscan rows, above a bias of 1000 ADU, was subtracted from each column.");
  FrameReadOptions options;
  options.use_overscan = false;
  const ImageFile raw = read_frame(path, options);
  EXPECT_EQ(raw.frame.pixels.view(0).at(1, 0), 1200.0F);
  EXPECT_TRUE(raw.notes.empty());
  options = {};
  options.bias = Adu(1004.0);
  EXPECT_EQ(read_frame(path, options).frame.pixels.view(0).at(1, 0), 1184.0F) << "the user knows better";
}

TEST(ReadFrame, LeavesOverscanThatLiesElsewhereAlone) {
  const test::TemporaryFolder folder;
  const ImageFile file = read_frame(write_with_reference_pixels(folder, 10));
  EXPECT_EQ(file.frame.pixels.view(0).at(1, 0), 1200.0F);
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_EQ(file.notes[0], "The OVERSCAN extension does not lie above the image (LTV1, LTV2) and was not used.");
}

}  // namespace
}  // namespace astroid
