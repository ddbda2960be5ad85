#include "astroid/core/fits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/wcs.hpp"
#include "astroid/test/file_size_limit.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string bytes_of(const std::filesystem::path& path) {
  std::string text;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  return text;
}

// A FITS file made of these header lines and so many data bytes.
std::filesystem::path raw_fits(const test::TemporaryFolder& folder, std::vector<std::string> cards,
                               std::size_t data_bytes) {
  cards.emplace_back("END");
  std::string text;
  for (std::string& card : cards) {
    card.resize(80, ' ');
    text += card;
  }
  text.resize((text.size() + 2879) / 2880 * 2880, ' ');
  text.resize(text.size() + data_bytes, '\0');
  return folder.write("raw.fits", text);
}

// Macros take no commas between template arguments.
Image<float, unit::Adu> floats(const FitsReader& reader, int unit) {
  return reader.read_image<float, unit::Adu>(unit);
}
Image<double, unit::Adu> doubles(const FitsReader& reader, int unit) {
  return reader.read_image<double, unit::Adu>(unit);
}
Image<float, unit::Adu> plane(const FitsReader& reader, int unit, int index) {
  return reader.read_plane<float, unit::Adu>(unit, index);
}
Image<double, unit::Adu> section(const FitsReader& reader, Rectangle area, int index) {
  return reader.read_section<double, unit::Adu>(1, area, index);
}

TEST(Fits, SixteenBitCountsSurviveTheRoundTrip) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "counts.fits";
  Image<std::uint16_t, unit::Adu> image(3, 2);
  const std::vector<std::uint16_t> counts = {0, 1, 32767, 32768, 65534, 65535};
  std::copy(counts.begin(), counts.end(), image.pixels().begin());
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned16, {3, 2});
  writer.write_plane(image);
  writer.commit();
  const FitsReader reader(path);
  const auto back = reader.read_image<float, unit::Adu>(reader.first_image());
  EXPECT_THAT(std::vector<float>(back.pixels().begin(), back.pixels().end()),
              ElementsAre(0, 1, 32767, 32768, 65534, 65535));
  EXPECT_EQ(reader.number(1, "BZERO"), 32768.0);
}

TEST(Fits, FloatFramesAreStoredAsCountsOrRefused) {
  const test::TemporaryFolder folder;
  FitsWriter writer(folder.path() / "counts.fits");
  writer.begin_image(FitsNumber::kUnsigned16, {2, 1});
  writer.write_pixels(0, std::vector<float>{0.0F, 65535.0F});
  for (const float wrong : {0.5F, -1.0F, 65536.0F, std::nanf("")}) {
    EXPECT_THROW(writer.write_pixels(0, std::vector<float>{wrong}), BugError) << wrong;
  }
  writer.commit();
  const FitsReader reader(folder.path() / "counts.fits");
  EXPECT_EQ(doubles(reader, 1).at(1, 0), 65535.0);
}

TEST(Fits, EveryFormatKeepsItsValues) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "formats.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat64, {3, 1}, "DOUBLES");
  writer.write_pixels(0, std::vector<double>{0.1, std::nan(""), -1e300});
  writer.begin_image(FitsNumber::kFloat32, {2, 1}, "FLOATS");
  writer.write_pixels(0, std::vector<float>{0.1F, std::nanf("")});
  writer.begin_image(FitsNumber::kInt32, {2, 1}, "INTEGERS");
  writer.write_pixels(0, std::vector<std::int32_t>{-2147483647 - 1, 2147483647});
  writer.begin_image(FitsNumber::kUnsigned8, {2, 1}, "FLAGS");
  writer.write_pixels(0, std::vector<std::uint8_t>{0, 255});
  writer.commit();
  const FitsReader reader(path);
  ASSERT_EQ(reader.units().size(), 4U);
  const auto fractions = doubles(reader, 1);
  EXPECT_EQ(fractions.at(0, 0), 0.1);
  EXPECT_TRUE(std::isnan(fractions.at(1, 0)));
  EXPECT_EQ(fractions.at(2, 0), -1e300);
  const auto singles = floats(reader, *reader.find_unit("floats"));
  EXPECT_EQ(singles.at(0, 0), 0.1F);
  EXPECT_TRUE(std::isnan(singles.at(1, 0)));
  const auto integers = doubles(reader, 3);
  EXPECT_EQ(integers.at(0, 0), -2147483648.0);
  EXPECT_EQ(integers.at(1, 0), 2147483647.0);
  EXPECT_EQ(doubles(reader, 4).at(1, 0), 255.0);
  EXPECT_FALSE(reader.find_unit("absent"));
}

TEST(Fits, CubesAreWrittenPlaneByPlaneAndReadInSections) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat32, {4, 3, 2});
  for (int z = 1; z >= 0; --z) {
    Image<float, unit::Adu> image(Rectangle{10, 20, 4, 3});
    std::iota(image.pixels().begin(), image.pixels().end(), 100.0F * static_cast<float>(z));
    const Image<float, unit::Adu>& constant = image;
    writer.write_plane(constant.view(), z);
  }
  writer.commit();
  const FitsReader reader(path);
  EXPECT_EQ(plane(reader, 1, 1).at(3, 2), 111.0F);
  const auto part = section(reader, {1, 1, 2, 2}, 1);
  EXPECT_EQ(part.area(), (Rectangle{1, 1, 2, 2}));
  EXPECT_EQ(part.at(1, 1), 105.0);
  EXPECT_EQ(part.at(2, 2), 110.0);
  EXPECT_THAT(
      [&] { (void)floats(reader, 1); },
      ThrowsMessage<InputError>(HasSubstr("cube.fits: unit 1 (an image of 4 x 3 x 2 px) cannot be used; expected a "
                                          "two-dimensional image")));
  EXPECT_THAT([&] { (void)plane(reader, 1, 2); }, ThrowsMessage<InputError>(HasSubstr("plane 2")));
  EXPECT_THAT([&] { (void)section(reader, {3, 0, 2, 1}, 0); }, ThrowsMessage<InputError>(HasSubstr("section")));
}

TEST(Fits, ImagesThatGrowTogetherAreWrittenInBlocks) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "lightcurves.fits";
  constexpr std::int64_t kExposures = 5000;
  constexpr std::int64_t kStars = 7;
  constexpr std::int64_t kBlock = 1024;
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned8, {});
  std::vector<int> cameras;
  cameras.reserve(2);
  for (int camera = 0; camera < 2; ++camera) {
    cameras.push_back(
        writer.begin_large_image(FitsNumber::kFloat32, {kExposures, kStars}, "CAMERA" + std::to_string(camera + 1)));
  }
  writer.begin_table({{.name = "FLAGS", .number = FitsNumber::kInt32}}, "FLAGS");
  const auto value = [](std::int64_t camera, std::int64_t star, std::int64_t exposure) {
    return static_cast<float>(camera * 100000 + star * 10000 + exposure);
  };
  for (std::int64_t first = 0; first < kExposures; first += kBlock) {
    const std::int64_t count = std::min(kBlock, kExposures - first);
    for (int camera = 0; camera < 2; ++camera) {
      writer.select(cameras[static_cast<std::size_t>(camera)]);
      for (std::int64_t star = 0; star < kStars; ++star) {
        std::vector<float> block;
        for (std::int64_t i = 0; i < count; ++i) block.push_back(value(camera, star, first + i));
        writer.write_pixels(star * kExposures + first, block);
      }
    }
    EXPECT_THROW(writer.card({"LATE", 1}), BugError);
    EXPECT_THROW(writer.write_pixels(0, std::vector<double>{1.0}), BugError);
    writer.select(4);
    writer.write_column(0, first / kBlock, std::vector<std::int32_t>{static_cast<std::int32_t>(first)});
  }
  writer.commit();
  const FitsReader reader(path);
  for (int camera = 0; camera < 2; ++camera) {
    const auto image =
        reader.read_image<float, unit::Relative>(*reader.find_unit("CAMERA" + std::to_string(camera + 1)));
    for (int star = 0; star < kStars; ++star) {
      for (int exposure = 0; exposure < kExposures; ++exposure) {
        ASSERT_EQ(image.at(exposure, star), value(camera, star, exposure));
      }
    }
  }
  EXPECT_THAT(reader.read_integers(4, 0), ElementsAre(0, 1024, 2048, 3072, 4096));
}

TEST(Fits, LargeImagesAreWrittenByThreadsAtATime) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "large.fits";
  constexpr std::int64_t kRows = 64;
  constexpr std::int64_t kColumns = 1000;
  constexpr std::int64_t kThreads = 4;
  FitsWriter writer(path);
  const int first = writer.begin_large_image(FitsNumber::kFloat32, {kColumns, kRows}, "A");
  EXPECT_THROW(writer.write_large_pixels(first, 0, std::vector<float>{1.0F}), BugError) << "the header has not ended";
  writer.card({"GAIN", 25.0});
  writer.end_large_header();
  EXPECT_THROW(writer.card({"LATE", 1}), BugError);
  const int second = writer.begin_large_image(FitsNumber::kFloat32, {kColumns, kRows}, "B");
  writer.end_large_header();
  const int doubles_unit = writer.begin_large_image(FitsNumber::kFloat64, {2, 2}, "C");
  writer.end_large_header();
  EXPECT_THROW(writer.write_large_pixels(doubles_unit, 0, std::vector<float>{1.0F}), BugError);
  EXPECT_THROW(writer.write_large_pixels(first, kRows * kColumns - 1, std::vector<float>{1.0F, 2.0F}), BugError);
  std::vector<std::jthread> threads;
  for (std::int64_t thread = 0; thread < kThreads; ++thread)
    threads.emplace_back([&, thread] {
      std::vector<float> row(kColumns);
      for (std::int64_t y = thread; y < kRows; y += kThreads)
        for (const int unit : {first, second}) {
          std::iota(row.begin(), row.end(), static_cast<float>(unit * 100000 + y * kColumns));
          writer.write_large_pixels(unit, y * kColumns, row);
        }
    });
  threads.clear();
  writer.begin_table({{.name = "LAST", .number = FitsNumber::kInt32}}, "LAST");
  EXPECT_THROW(writer.end_large_header(), BugError) << "a table";
  writer.commit();
  const FitsReader reader(path);
  for (const int unit : {first, second}) {
    const auto image = reader.read_image<float, unit::Relative>(unit);
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x)
        ASSERT_EQ(image.at(x, y), static_cast<float>(unit * 100000 + y * kColumns + x)) << x << " " << y;
  }
}

TEST(Fits, LargeImagesKeepEveryFormatAndAreZeroWhereUnwritten) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "large.fits";
  FitsWriter writer(path);
  writer.begin_large_image(FitsNumber::kUnsigned16, {2, 2}, "COUNTS");
  writer.card({"GAIN", 25.0});
  writer.write_pixels(1, std::vector<std::uint16_t>{0, 65535});
  writer.begin_large_image(FitsNumber::kFloat64, {2, 2}, "DOUBLES");
  writer.write_pixels(3, std::vector<double>{0.1});
  writer.begin_large_image(FitsNumber::kInt32, {2, 2}, "INTEGERS");
  writer.write_pixels(0, std::vector<std::int32_t>{-5});
  writer.begin_large_image(FitsNumber::kUnsigned8, {20000, 10}, "FLAGS");
  writer.write_pixels(199999, std::vector<std::uint8_t>{255});
  writer.begin_large_image(FitsNumber::kFloat32, {3, 1}, "UNTOUCHED");
  writer.commit();
  const FitsReader reader(path);
  ASSERT_EQ(reader.units().size(), 5U);
  EXPECT_EQ(reader.number(1, "GAIN"), 25.0);
  EXPECT_EQ(doubles(reader, 1).at(1, 0), 0.0);
  EXPECT_EQ(doubles(reader, 1).at(0, 1), 65535.0);
  EXPECT_EQ(doubles(reader, 2).at(1, 1), 0.1);
  EXPECT_EQ(doubles(reader, 2).at(0, 0), 0.0);
  EXPECT_EQ(doubles(reader, 3).at(0, 0), -5.0);
  EXPECT_EQ(doubles(reader, 4).at(19999, 9), 255.0);
  EXPECT_EQ(doubles(reader, 5).at(2, 0), 0.0);
}

TEST(Fits, KeywordsReadBackExactly) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "header.fits";
  const std::string long_text(150, 'x');
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned8, {});
  const std::vector<FitsCard> cards = {{"GAIN", 1.0 / 3.0, "[e-/ADU]"},
                                       {"WHOLE", 25.0},
                                       {"BIG", -1.5e300},
                                       {"COUNT", std::int64_t{1} << 53},
                                       {"FLAG", true},
                                       {"NAME", "it's"},
                                       {"LONG", long_text},
                                       {"NOTHING", std::nan("")},
                                       {"GREEK", "5 \xC2\xB5m"}};
  writer.cards(cards);
  writer.card({"WHOLE", 26.0});
  writer.history("first line");
  writer.history(std::string(100, 'h'));
  writer.commit();
  const FitsReader reader(path);
  EXPECT_EQ(reader.number(1, "GAIN"), 1.0 / 3.0);
  EXPECT_EQ(reader.number(1, "whole"), 26.0);
  EXPECT_EQ(reader.number(1, "BIG"), -1.5e300);
  EXPECT_EQ(reader.integer(1, "COUNT"), std::int64_t{1} << 53);
  EXPECT_EQ(reader.integer(1, "WHOLE"), 26);
  EXPECT_EQ(reader.flag(1, "FLAG"), true);
  EXPECT_EQ(reader.text(1, "NAME"), "it's");
  EXPECT_EQ(reader.text(1, "LONG"), long_text);
  EXPECT_EQ(reader.text(1, "NOTHING"), "nan");
  EXPECT_EQ(reader.text(1, "GREEK"), "5 ??m");
  EXPECT_FALSE(reader.number(1, "ABSENT"));
  EXPECT_FALSE(reader.text(1, "CREATOR"));
  EXPECT_THAT([&] { (void)reader.number(1, "NAME"); },
              ThrowsMessage<InputError>(
                  HasSubstr("header.fits: keyword NAME of unit 1 (a header without data) is not a number")));
  EXPECT_THROW((void)reader.integer(1, "GAIN"), InputError);
  EXPECT_THROW((void)reader.flag(1, "NAME"), InputError);
  EXPECT_THAT(reader.history(1), ElementsAre("first line", std::string(72, 'h'), std::string(28, 'h')));
  EXPECT_EQ(reader.header_text(1).size() % 80, 0U);
  EXPECT_THROW(FitsWriter(folder.path() / "b.fits").card({"MUCHTOOLONG", 1}), BugError);
}

TEST(Fits, TablesReadBack) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "table.fits";
  FitsWriter writer(path);
  writer.begin_table({{.name = "ID", .text_width = 8},
                      {.name = "MAG", .number = FitsNumber::kFloat64, .unit = "mag"},
                      {.name = "FLUX", .number = FitsNumber::kFloat32},
                      {.name = "FLAGS", .number = FitsNumber::kInt32},
                      {.name = "SOURCE", .number = FitsNumber::kInt64}},
                     "STARS");
  writer.write_column(0, 0, std::vector<std::string>{"a", "", "eightchr"});
  writer.write_column(1, 0, std::vector<double>{0.1, std::nan(""), 3.0});
  writer.write_column(2, 0, std::vector<float>{1.5F, 2.5F, 3.5F});
  writer.write_column(3, 0, std::vector<std::int32_t>{1, -2, 3});
  writer.write_column(4, 0, std::vector<std::int64_t>{5853498713190525696, 0, -1});
  writer.write_column(1, 3, std::vector<double>{4.0, 5.0});  // a second block of rows
  EXPECT_THROW(writer.write_column(0, 0, std::vector<std::string>{"nine char"}), BugError);
  writer.commit();
  const FitsReader reader(path);
  const int table = reader.first_table();
  EXPECT_EQ(table, 2);
  EXPECT_EQ(reader.units()[1].text(), "a table of 5 rows");
  EXPECT_EQ(reader.columns(table)[1].unit, "mag");
  EXPECT_EQ(reader.find_column(table, "mag"), 1U);
  EXPECT_FALSE(reader.find_column(table, "colour"));
  EXPECT_THAT(reader.read_texts(table, 0), ElementsAre("a", "", "eightchr", "", ""));
  const auto magnitudes = reader.read_numbers(table, 1);
  EXPECT_EQ(magnitudes[0], 0.1);
  EXPECT_TRUE(std::isnan(magnitudes[1]));
  EXPECT_EQ(magnitudes[4], 5.0);
  EXPECT_THAT(reader.read_numbers(table, 2, 1, 2), ElementsAre(2.5, 3.5));
  EXPECT_EQ(reader.read_integers(table, 4)[0], 5853498713190525696);
  EXPECT_THAT(reader.read_integers(table, 3, 1, 2), ElementsAre(-2, 3));
  EXPECT_THROW((void)reader.read_integers(table, 3, 4, 2), InputError);
  EXPECT_THROW((void)reader.read_integers(table, 3, -1, 2), InputError);
  EXPECT_EQ(reader.read_texts(table, 4)[0], "5853498713190525696");
  EXPECT_THROW((void)reader.read_integers(table, 1), InputError);
  EXPECT_THROW((void)reader.read_numbers(table, 0), InputError);
  EXPECT_THROW((void)reader.read_numbers(table, 9), InputError);
  EXPECT_THROW((void)reader.read_numbers(table, 1, 4, 2), InputError);
  EXPECT_THAT([&] { (void)reader.first_image(); }, ThrowsMessage<InputError>(HasSubstr("holds no image")));
}

TEST(Fits, AppearsOnlyWhenCommitted) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "image.fits";
  {
    FitsWriter writer(path);
    writer.begin_image(FitsNumber::kFloat32, {2, 2});
    EXPECT_TRUE(std::filesystem::exists(partial_path(path)));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  folder.write("image.fits.partial", "left by a run that was killed");
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat32, {2, 2});
  EXPECT_FALSE(std::filesystem::exists(path));
  writer.commit();
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(partial_path(path)));
  EXPECT_THROW(writer.history("late"), BugError);
}

TEST(Fits, AFullDiskIsReportedAndLeavesNothing) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "big.fits";
  {
    const test::FileSizeLimit limit(100000);
    const auto write = [&] {
      FitsWriter writer(path);
      writer.begin_image(FitsNumber::kFloat32, {1000, 1000});
      const std::vector<float> row(1000, 1.0F);
      for (std::int64_t y = 0; y < 1000; ++y) writer.write_pixels(y * 1000, row);
      writer.commit();
    };
    EXPECT_THAT(write, ThrowsMessage<EnvironmentError>(HasSubstr("big.fits: ")));
    const auto write_large = [&] {
      FitsWriter writer(path);
      writer.begin_large_image(FitsNumber::kFloat32, {1000, 1000});
      writer.write_pixels(0, std::vector<float>{1.0F});
    };
    EXPECT_THAT(write_large, ThrowsMessage<EnvironmentError>(HasSubstr("big.fits: File too large")));
    // So small that CFITSIO's buffers meet the disk only when the file is closed.
    const auto write_at_the_end = [&] {
      FitsWriter writer(path);
      writer.begin_image(FitsNumber::kFloat32, {160, 160});
      writer.write_pixels(0, std::vector<float>(25600, 1.0F));
      writer.commit();
    };
    EXPECT_THAT(write_at_the_end, ThrowsMessage<EnvironmentError>(HasSubstr("big.fits: ")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THAT([&] { FitsWriter(folder.path() / "no" / "image.fits"); },
              ThrowsMessage<EnvironmentError>(HasSubstr("no/image.fits: ")));
}

TEST(Fits, IsTheSameToTheByteForOneDate) {
  const test::TemporaryFolder folder;
  setenv("SOURCE_DATE_EPOCH", "1800000000", 1);
  for (const char* name : {"a.fits", "b.fits"}) {
    FitsWriter writer(folder.path() / name);
    writer.begin_image(FitsNumber::kFloat32, {2, 1});
    writer.write_pixels(0, std::vector<float>{1.0F, 2.0F});
    writer.commit();
  }
  unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(bytes_of(folder.path() / "a.fits"), bytes_of(folder.path() / "b.fits"));
  EXPECT_EQ(FitsReader(folder.path() / "a.fits").text(1, "DATE"), "2027-01-15T08:00:00");
}

TEST(FitsReader, SaysWhatIsNotFits) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { FitsReader(folder.path() / "absent.fits"); },
              ThrowsMessage<EnvironmentError>(HasSubstr("absent.fits: No such file")));
  EXPECT_THAT([&] { FitsReader(folder.path()); }, ThrowsMessage<EnvironmentError>(HasSubstr("directory")));
  EXPECT_THAT([&] { FitsReader(folder.write("empty.fits", "")); },
              ThrowsMessage<InputError>(HasSubstr("empty.fits: is empty")));
  EXPECT_THAT([&] { FitsReader(folder.write("text.fits", std::string(5000, 'x'))); },
              ThrowsMessage<InputError>(HasSubstr("text.fits: is not a FITS file")));
  EXPECT_THAT([&] { FitsReader(folder.write("short.fits", "SIMPLE  =                    T")); },
              ThrowsMessage<InputError>(HasSubstr("short.fits: is truncated")));
}

TEST(FitsReader, RefusesATruncatedImage) {
  const test::TemporaryFolder folder;
  const auto path =
      raw_fits(folder,
               {"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    2",
                "NAXIS1  =                  100", "NAXIS2  =                  100"},
               2880);
  const FitsReader reader(path);
  EXPECT_THAT([&] { (void)floats(reader, 1); },
              ThrowsMessage<InputError>(HasSubstr(
                  "is truncated: unit 1 (an image of 100 x 100 px) needs 20000 bytes of data, the file has 2880")));
}

TEST(FitsReader, DoesNotBelieveHugeAxes) {
  const test::TemporaryFolder folder;
  for (const char* length : {"          2000000000", " 9000000000000000000"}) {
    const auto path =
        raw_fits(folder,
                 {"SIMPLE  =                    T", "BITPIX  =                  -64", "NAXIS   =                    2",
                  std::string("NAXIS1  =") + length, std::string("NAXIS2  =") + length},
                 2880);
    EXPECT_THROW((void)doubles(FitsReader(path), 1), InputError) << length;
  }
  const auto path =
      raw_fits(folder,
               {"SIMPLE  =                    T", "BITPIX  =                  -64", "NAXIS   =                    2",
                "NAXIS1  =                   -3", "NAXIS2  =                    3"},
               2880);
  EXPECT_THROW((void)doubles(FitsReader(path), 1), InputError);
}

TEST(FitsReader, RefusesOtherThanTwoDimensions) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "none.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned8, {});
  writer.begin_image(FitsNumber::kFloat32, {5}, "LINE");
  writer.begin_image(FitsNumber::kFloat32, {2, 2, 1}, "THIN");
  writer.commit();
  const FitsReader reader(path);
  EXPECT_EQ(reader.first_image(), 2);
  EXPECT_THAT([&] { (void)floats(reader, 1); },
              ThrowsMessage<InputError>(HasSubstr("unit 1 (a header without data) cannot be used; expected an image")));
  EXPECT_THAT([&] { (void)floats(reader, 2); },
              ThrowsMessage<InputError>(
                  HasSubstr("unit 2 (LINE, an image of 5 px) cannot be used; expected a two-dimensional image")));
  EXPECT_EQ(floats(reader, 3).nx(), 2);
  EXPECT_THAT([&] { (void)floats(reader, 4); }, ThrowsMessage<InputError>(HasSubstr("has no unit 4")));
  EXPECT_THAT([&] { (void)reader.columns(2); }, ThrowsMessage<InputError>(HasSubstr("expected a table")));
}

TEST(FitsReader, AppliesScaleAndBlank) {
  const test::TemporaryFolder folder;
  auto path =
      raw_fits(folder,
               {"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    2",
                "NAXIS1  =                    2", "NAXIS2  =                    1", "BSCALE  =                  0.5",
                "BZERO   =                 10.0", "BLANK   =                    0"},
               2880);
  std::string bytes = bytes_of(path);
  bytes[2880 + 3] = 4;  // second pixel: 4, big-endian
  path = folder.write("scaled.fits", bytes);
  const FitsReader reader(path);
  const auto image = doubles(reader, 1);
  EXPECT_TRUE(std::isnan(image.at(0, 0)));
  EXPECT_EQ(image.at(1, 0), 12.0);
}

// Bytes of a good file changed at random: every one is read or refused, whatever CFITSIO and WCSLIB make of it.
TEST(FitsReader, ReadsOrRefusesDamagedFiles) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "good.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kUnsigned16, {4, 3});
  writer.cards(SkyProjection(CameraPointing{.axis = {10.0, 20.0}, .roll = Degrees(5.0)}).fits_cards());
  writer.write_pixels(0, std::vector<std::uint16_t>(12, 1000));
  writer.commit();
  const std::string good = bytes_of(path);
  std::uint32_t state = 1;
  const auto next = [&](std::size_t below) {
    state = state * 1664525U + 1013904223U;  // Knuth's linear congruence: any damage will do
    return static_cast<std::size_t>(state >> 8U) % below;
  };
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    std::string bytes = good;
    for (std::size_t k = 0; k <= next(4); ++k) {
      const std::size_t card = next(2880 / 80) * 80;
      bytes[card + next(40)] = "0123456789-E.'TF /\x01"[next(19)];
    }
    if (next(10) == 0) bytes.resize(next(bytes.size()));
    try {
      const FitsReader reader(folder.write("damaged.fits", bytes));
      (void)SkyProjection::from_header(reader.header_text(1), "damaged.fits");
      (void)doubles(reader, reader.first_image());
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 50);
}

TEST(FitsReader, ReadsOneFileFromSeveralThreads) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "image.fits";
  FitsWriter writer(path);
  writer.begin_image(FitsNumber::kFloat64, {64, 64});
  std::vector<double> values(4096);
  std::iota(values.begin(), values.end(), 0.0);
  writer.write_pixels(0, values);
  writer.commit();
  std::vector<int> wrong(4);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) {
        const FitsReader reader(path);
        const auto image = doubles(reader, 1);
        if (!std::equal(values.begin(), values.end(), image.pixels().begin())) ++wrong[t];
      }
    });
  }
  threads.clear();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(FitsReader, ReadsRealImages) {
  const auto kepler = test::shared_data("images/kepler_ffi_ch01_cutout.fits");
  if (!kepler) GTEST_SKIP() << "no shared data";
  const FitsReader reader(*kepler);
  EXPECT_EQ(reader.first_image(), 2);
  EXPECT_EQ(floats(reader, 2).nx(), 200);
  const FitsReader m13(*test::shared_data("images/M13_blue_0001.fits"));
  EXPECT_EQ(floats(m13, 1).area(), (Rectangle{0, 0, 1392, 1040}));
  const FitsReader table(*test::shared_data("images/stellarphot_ey_uma_table.fits"));
  for (std::size_t i = 0; i < table.columns(2).size(); ++i) {
    if (table.columns(2)[i].per_row == 1) {
      EXPECT_EQ(static_cast<std::int64_t>(table.read_texts(2, i).size()), table.units()[1].rows);
    }
  }
}

}  // namespace
}  // namespace astroid
