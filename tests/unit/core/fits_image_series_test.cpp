#include "astroid/core/fits_image_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/fits_reader.hpp"
#include "astroid/core/product_folder.hpp"
#include "astroid/test/file_size_limit.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "fits_checksum.hpp"

namespace astroid {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<FitsCard> kCards = {{"TELESCOP", "ASTROID", "simulated"},
                                      {"OWNER", "O'Neill's", "quotes"},
                                      {"EMPTY", ""},
                                      {"SIMULATE", true, "a flag"},
                                      {"EXPOSURE", -12, "an integer"},
                                      {"MJD-OBS", 61041.123456789012, "[d]"},
                                      {"LARGE", 1e22, "[e-] a number"},
                                      {"NAN", std::nan(""), "not a number"},
                                      {"SMALL", -1.5e-300, "sixteen digits"},
                                      {"LONGTEXT", std::string(200, 'x')},
                                      {"LONGNOTE", 1.0, std::string(90, 'c')}};
const std::vector<std::string> kHistory = {"a line", std::string(100, 'h'), "µ becomes two question marks"};

class FitsImageSeriesWriting : public ::testing::Test {
 protected:
  void SetUp() override { setenv("SOURCE_DATE_EPOCH", "1800000000", 1); }
  void TearDown() override { unsetenv("SOURCE_DATE_EPOCH"); }
  test::TemporaryFolder folder_;
};

TEST_F(FitsImageSeriesWriting, IsTheWritersToTheByte) {
  for (const FitsNumber number : {FitsNumber::kUnsigned16, FitsNumber::kInt32}) {
    // Odd numbers of pixels, a block exactly, less and more than is written at a time.
    for (const auto& [nx, ny] : std::vector<std::pair<int, int>>{{1, 1}, {3, 5}, {1440, 1}, {720, 1}, {301, 307}}) {
      std::vector<float> counts(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<float>(i * 7919 % 65536);
      counts.back() = 65535.0F;
      const std::vector<FitsCard> changed = {{"EXPOSURE", 24191, "an integer"}, {"OWNER", "'", "quotes"}};
      const FitsImageSeries series(number, nx, ny, kCards, kHistory);
      series.write(folder_.path() / "series.fits", counts, changed, Durability::kWithFolder);
      FitsWriter writer(folder_.path() / "writer.fits");
      writer.begin_image(number, {nx, ny});
      writer.cards(kCards);
      writer.cards(changed);
      for (const std::string& line : kHistory) writer.history(line);
      writer.write_pixels(0, counts);
      writer.commit();
      EXPECT_EQ(sha256_of_file(folder_.path() / "series.fits"), sha256_of_file(folder_.path() / "writer.fits"))
          << nx << " x " << ny;
    }
  }
}

TEST_F(FitsImageSeriesWriting, RefusesPixelsThatAreNotWholeNumbersInRange) {
  const FitsImageSeries counts(FitsNumber::kUnsigned16, 2, 1, {}, {});
  const FitsImageSeries integers(FitsNumber::kInt32, 2, 1, {}, {});
  const auto path = folder_.path() / "image.fits";
  const auto write = [&](const FitsImageSeries& series, float value) {
    series.write(path, std::vector<float>{0.0F, value}, {}, Durability::kAtOnce);
  };
  for (const float wrong : {0.5F, -1.0F, 65536.0F, std::nanf(""), std::numeric_limits<float>::infinity()})
    EXPECT_THROW(write(counts, wrong), BugError) << wrong;
  for (const float wrong : {-0.5F, 2147483648.0F, -2147483904.0F, std::nanf("")})
    EXPECT_THROW(write(integers, wrong), BugError) << wrong;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  write(integers, -2147483648.0F);
  write(counts, 65535.0F);
  EXPECT_EQ((FitsReader(path).read_image<double, unit::Adu>(1).at(1, 0)), 65535.0);
}

TEST_F(FitsImageSeriesWriting, ChangesOnlyCardsThatAreThere) {
  const FitsImageSeries series(FitsNumber::kUnsigned16, 1, 1, kCards, {});
  const std::vector<float> counts{1.0F};
  for (const FitsCard& wrong :
       {FitsCard{"ABSENT", 1}, FitsCard{"OWNER", std::string(69, 'x')}, FitsCard{"MUCHTOOLONG", 1}, FitsCard{"", 1}})
    EXPECT_THROW(series.write(folder_.path() / "a.fits", counts, {&wrong, 1}, Durability::kAtOnce), BugError)
        << wrong.key;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(FitsImageSeriesWriting, ReportsAFullDiskAndLeavesNothing) {
  const FitsImageSeries series(FitsNumber::kUnsigned16, 300, 300, {}, {});
  const std::vector<float> counts(90000, 1.0F);
  {
    const test::FileSizeLimit limit(100000);
    EXPECT_THAT([&] { series.write(folder_.path() / "big.fits", counts, {}, Durability::kWithFolder); },
                ThrowsMessage<EnvironmentError>(HasSubstr("big.fits: File too large")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  EXPECT_THAT([&] { series.write(folder_.path() / "no" / "a.fits", counts, {}, Durability::kWithFolder); },
              ThrowsMessage<EnvironmentError>(HasSubstr("no/a.fits: No such file or directory")));
}

// The standard's definition, a word at a time.
TEST(FitsSum, AddsBigEndianWordsInOnesComplement) {
  const auto slow_sum = [](const std::string& bytes, std::uint32_t sum) {
    std::uint64_t total = sum;
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) word = word << 8U | static_cast<unsigned char>(bytes[i + k]);
      total += word;
      total = (total & 0xFFFFFFFFU) + (total >> 32U);
    }
    return static_cast<std::uint32_t>(total);
  };
  EXPECT_EQ(fits_sum("", 0x01020304U), 0x01020304U);
  EXPECT_EQ(fits_sum(std::string("\x00\x00\x00\x01", 4), 0), 1U);
  EXPECT_EQ(fits_sum(std::string("\xFF\xFF\xFF\xFF\x00\x00\x00\x01", 8), 0), 1U);
  EXPECT_EQ(fits_sum(std::string(8, '\0'), 0), 0U);
  EXPECT_EQ(fits_sum(std::string(4096, '\xFF'), 0), 0xFFFFFFFFU);
  std::string bytes;
  std::uint32_t state = 1;
  for (int i = 0; i < 4 * 1237; ++i) {
    state = state * 1664525U + 1013904223U;  // Knuth's linear congruence: any bytes will do
    bytes += static_cast<char>(state >> 24U);
    if (bytes.size() % 4 == 0) {
      ASSERT_EQ(fits_sum(bytes, state), slow_sum(bytes, state)) << bytes.size();
    }
  }
}

}  // namespace
}  // namespace astroid
