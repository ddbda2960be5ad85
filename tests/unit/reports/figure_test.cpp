#include "astroid/reports/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "astroid/core/atomic_file.hpp"
#include "astroid/test/temporary_folder.hpp"
#include "figure_tools.hpp"

namespace astroid {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Figure line_figure(const std::string& name, const std::string& commands) {
  Figure figure;
  figure.name = name;
  figure.title = "A line";
  figure.data = {{name + ".csv", "x,y\n1,2\n2,4\n"}};
  figure.commands = commands;
  return figure;
}

TEST(Figures, AreDrawnInThreeFormatsWithScriptAndDataBeside) {
  if (!have_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const test::TemporaryFolder folder;
  const std::vector<Figure> figures{line_figure("line", "  plot \"line.csv\" skip 1 using 1:2 with lines\n")};
  EXPECT_THAT(draw_figures(folder.path(), figures), IsEmpty());
  const auto begin = [&folder](const char* file) {
    std::ifstream in(folder.path() / file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {}).substr(0, 200);
  };
  EXPECT_EQ(begin("line.png").substr(1, 3), "PNG");
  EXPECT_EQ(begin("line.pdf").substr(0, 4), "%PDF");
  EXPECT_THAT(begin("line.svg"), HasSubstr("<svg"));
  EXPECT_EQ(begin("line.csv"), "x,y\n1,2\n2,4\n");
  EXPECT_THAT(begin("line.gp"), HasSubstr("gnuplot line.gp"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "line.log"));
}

TEST(Figures, ThatFailAreNamedAndTheOthersDrawn) {
  if (!have_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const test::TemporaryFolder folder;
  const std::vector<Figure> figures{line_figure("broken", "  plot \"nowhere.csv\" skip 1 using 1:2 with lines\n"),
                                    line_figure("line", "  plot \"line.csv\" skip 1 using 1:2 with lines\n")};
  const auto problems = draw_figures(folder.path(), figures);
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_THAT(problems[0], HasSubstr("figure broken was not drawn"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "line.png"));
}

TEST(GnuplotText, TakesTheMarkupOutOfNames) {
  EXPECT_EQ(gnuplot_text("PIC_1 {x} \"q\""), "PIC\\\\_1 \\\\{x\\\\} ''q''");
  EXPECT_EQ(gnuplot_text("a\\b`date`\n"), "a b date  ");
}

TEST(AxisRange, HoldsAllButTheTailsAndSurvivesNothing) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(i);
  values.push_back(1e9);
  const AxisRange range = robust_range(values, 0.01, 0.0);
  EXPECT_NEAR(range.low, 10.0, 1.0);
  EXPECT_NEAR(range.high, 991.0, 1.0);
  EXPECT_EQ(full_range({}, 0.1).high, 1.0);
  const std::vector<double> one{5.0};
  EXPECT_LT(full_range(one, 0.1).low, full_range(one, 0.1).high);
}

TEST(Tics, AreRoundNumbers) {
  EXPECT_EQ(tic_step({-2.3, 2.4}), 1.0);
  EXPECT_EQ(tic_step({0.0, 0.09}), 0.02);
  EXPECT_EQ(log_tics("y", {18.0, 210.0}), "  set ytics (\"20\" 20, \"50\" 50, \"100\" 100, \"200\" 200)\n");
  EXPECT_THAT(log_tics("y", {1e-6, 1e-1}), HasSubstr("\"10^{-5}\" 1e-05"));
}

TEST(Points, AreThinnedWhereThereAreTooMany) {
  EXPECT_EQ(thinning(100), 1U);
  EXPECT_EQ(thinning(32240), 6U);
  EXPECT_EQ(thinning_text(1), "");
  EXPECT_THAT(thinning_text(6), HasSubstr("One star in 6"));
  EXPECT_EQ(with_transparency("#2f6690", 144), "#902f6690");
}

}  // namespace
}  // namespace astroid
