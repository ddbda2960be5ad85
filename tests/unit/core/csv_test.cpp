#include "astroid/core/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> row(const CsvTable& table, std::size_t index) {
  std::vector<std::string> fields;
  for (std::size_t i = 0; i < table.columns(); ++i) fields.emplace_back(table.field(index, i));
  return fields;
}

std::vector<Problem> problems_of(const std::string& text) {
  try {
    (void)parse_csv(text, "stars.csv");
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

TEST(ShortestText, ReadsBackAsTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -0.0, 123456789.125, 1e22}) {
    const auto back = parse_number(shortest_text(value));
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(*back, value);
    EXPECT_EQ(std::signbit(*back), std::signbit(value));
  }
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(-std::nan("")), "nan");
}

TEST(ParseNumber, WantsTheWholeText) {
  EXPECT_EQ(parse_number(" +1.5e3 "), 1500.0);
  EXPECT_FALSE(parse_number("1.5x"));
  EXPECT_FALSE(parse_number(""));
  EXPECT_FALSE(parse_number("+-1"));
  EXPECT_FALSE(parse_number("1e999"));
  EXPECT_EQ(parse_integer("-42"), -42);
  EXPECT_FALSE(parse_integer("4.2"));
}

TEST(CsvWriter, WritesWhatTheReaderReads) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "table.csv";
  CsvWriter writer(path, {"id", "ra", "n", "flag", "e"});
  writer.row("a,\"b\" #1", 0.1, std::int64_t{-7}, true, 1.5F);
  writer.row(" padded ", std::nan(""), std::numeric_limits<std::uint64_t>::max(), false, 0.1F);
  writer.row("two\nlines", -std::numeric_limits<double>::infinity(), 0, false, 1e30F);
  writer.commit();
  EXPECT_EQ(read_text_file(path),
            "id,ra,n,flag,e\n\"a,\"\"b\"\" #1\",0.1,-7,1,1.5\n\" padded \",nan,18446744073709551615,0,0.1\n"
            "two lines,-inf,0,0,1e+30\n");
  const CsvTable table = read_csv(path);
  EXPECT_THAT(row(table, 0), ElementsAre("a,\"b\" #1", "0.1", "-7", "1", "1.5"));
  EXPECT_THAT(row(table, 1), ElementsAre(" padded ", "nan", "18446744073709551615", "0", "0.1"));
  EXPECT_EQ(table.number(2, 1), -std::numeric_limits<double>::infinity());
}

TEST(CsvWriter, RefusesARowOfAnotherLength) {
  const test::TemporaryFolder folder;
  CsvWriter writer(folder.path() / "table.csv", {"a", "b"});
  EXPECT_THROW(writer.row(1.0), BugError);
}

TEST(CsvReader, TakesByteOrderMarkAnyLineEndsEmptyLinesAndComments) {
  const CsvTable table =
      parse_csv("\xEF\xBB\xBF# made by hand\r\nra, dec ,mag\r\n\r\n1,2,3\r4,5,6,\n  # end\n7,8,9", "stars.csv");
  EXPECT_THAT(table.header(), ElementsAre("ra", "dec", "mag"));
  EXPECT_EQ(table.header_line(), 2);
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_THAT(row(table, 1), ElementsAre("4", "5", "6"));
  EXPECT_EQ(table.line(0), 4);
  EXPECT_EQ(table.line(2), 7);
  ASSERT_EQ(table.comments().size(), 2U);
  EXPECT_EQ(table.comments()[0].text, "made by hand");
  EXPECT_EQ(table.comments()[1].line, 6);
}

TEST(CsvReader, GuessesTheSeparatorAndWhetherThereIsAHeader) {
  const CsvTable bare = parse_csv("  178.83199 -70.901917\t14.099 \n178.84 -70.91 14.1\n", "old.txt");
  EXPECT_TRUE(bare.header().empty());
  EXPECT_EQ(bare.header_line(), 0);
  EXPECT_EQ(bare.rows(), 2U);
  EXPECT_EQ(bare.number(0, 2), 14.099);
  EXPECT_THAT(row(parse_csv("a\tb\n\tx y\n", "t"), 0), ElementsAre("", "x y"));
  EXPECT_THAT(row(parse_csv("a;b\n1;\n", "t"), 0), ElementsAre("1", ""));
  EXPECT_THAT(row(parse_csv("id \"the name\"\n1 \"x \"\"y\"\"\"\n", "t"), 0), ElementsAre("1", "x \"y\""));
  EXPECT_EQ(parse_csv("1 2\n", "t", {.header = CsvHeader::kPresent}).rows(), 0U);
  EXPECT_EQ(parse_csv("a b\n", "t", {.header = CsvHeader::kAbsent}).rows(), 1U);
  EXPECT_EQ(parse_csv("1, 2\n", "t", {.separator = CsvSeparator::kBlanks}).header().at(0), "1,");
}

TEST(CsvReader, FindsColumnsWhateverTheirCase) {
  const CsvTable table = parse_csv("RA,ra,Dec\n1,2,3\n", "t");
  EXPECT_EQ(table.column("ra"), 1U);
  EXPECT_EQ(table.column("Ra"), 0U);
  EXPECT_EQ(table.column("DEC"), 2U);
  EXPECT_FALSE(table.column("mag"));
}

TEST(CsvReader, ReportsEveryProblemWithItsLine) {
  const auto problems = problems_of("ra,dec\n1\n1,2,3\n\"1,2\n\"1\"x,2\n1,2\n");
  ASSERT_EQ(problems.size(), 4U);
  EXPECT_EQ(problems[0].text(), "stars.csv:2: the row has 1 field; expected 2, as in the header");
  EXPECT_EQ(problems[1].text(), "stars.csv:3: the row has 3 fields; expected 2, as in the header");
  EXPECT_THAT(problems[2].text(), HasSubstr("stars.csv:4: the quote of field 1 is not closed"));
  EXPECT_THAT(problems[3].text(), HasSubstr("stars.csv:5: text follows the closing quote of field 1"));
}

TEST(CsvReader, StopsAtAHundredProblems) {
  std::string text = "ra,dec\n";
  for (int i = 0; i < 1000; ++i) text += "1\n";
  EXPECT_EQ(problems_of(text).size(), 100U);
}

TEST(CsvReader, RefusesWhatIsNoTable) {
  EXPECT_THAT(problems_of("").at(0).text(), HasSubstr("stars.csv: is empty"));
  EXPECT_THAT(problems_of("# only a comment\n\n").at(0).text(), HasSubstr("is empty"));
  EXPECT_THAT(problems_of(std::string("a\0b", 3)).at(0).text(), HasSubstr("stars.csv:1: contains a NUL"));
  EXPECT_THAT(problems_of("a,b\n" + std::string(2000000, '1')).at(0).text(),
              HasSubstr(":2: the line is 2000000 bytes"));
}

TEST(CsvReader, PointsAtOneField) {
  const CsvTable table = parse_csv("ra,dec\n1,x\n", "stars.csv");
  EXPECT_EQ(table.problem(0, 1, "is not a number", "degrees").text(),
            "stars.csv:2: column dec = x: is not a number; expected degrees");
}

TEST(CsvReader, KeepsItsFieldsWhenTheTableMoves) {
  CsvTable table = parse_csv("a\nx\n", "t");
  const CsvTable moved = std::move(table);
  EXPECT_EQ(moved.field(0, 0), "x");
}

TEST(CsvReader, ReadsARealEcsvCatalogue) {
  const auto path = test::shared_data("catalogues/refcat2_ey_uma.ecsv");
  if (!path) GTEST_SKIP() << "no shared data";
  const CsvTable table = read_csv(*path);
  EXPECT_TRUE(table.column("RA_ICRS"));
  EXPECT_GT(table.rows(), 100U);
}

}  // namespace
}  // namespace astroid
