#include "astroid/reports/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/HTMLparser.h>
#include <libxml/xmlerror.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "astroid/analysis/verdict.hpp"
#include "astroid/core/atomic_file.hpp"
#include "astroid/reports/figure.hpp"
#include "astroid/test/synthetic_targets.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// A report with everything in it, and texts that try to be markup.
class FullReport {
 public:
  FullReport() : targets_(test::synthetic_targets({.stars = 300, .bins = 24})), image_(40, 30) {
    constexpr const char* kHostile = "<script>alert('&\"')</script>";
    targets_[0].id = kHostile;
    targets_[0].flags |= measurement_flag::kEdge | measurement_flag::kContaminated;
    input_.title = std::string("field ") + kHostile;
    input_.setup = test::plato_setup();
    input_.passband = "P";
    input_.requirement = plato_requirement(24);
    input_.targets = targets_;
    input_.verdict = verdict(targets_, input_.setup, 1.0, input_.requirement);
    for (const TargetMetrics& t : targets_) {
      contamination_.push_back(
          {t.id, t.mag, t.spr_tot, t.causes.contamination, {{kHostile, 1.0, -0.5, 1e3, 0.8 * t.spr_tot}}});
    }
    input_.contamination = contamination_;
    for (int mag = 6; mag < 15; ++mag) {
      BudgetRow row;
      row.mag = mag;
      row.nsr_1h_ppm = mag * 10.0;
      row.causes.photon = mag * 9.0;
      row.saturated = mag < 8;
      budget_.push_back(row);
    }
    input_.budget = budget_;
    input_.plan = kHostile;
    input_.configuration = {{"CCD/Gain", "25", "e-/ADU", "plato.xml:12"}, {"CCD/Bias", kHostile, "ADU", "default"}};
    input_.provenance = {{"host", kHostile}, {"seed", "42"}};
    input_.warnings = {kHostile};
    test::GaussianSeries gauss(1);
    for (float& pixel : image_.pixels()) pixel = static_cast<float>(1000.0 + 3.0 * gauss.next());
    image_.at(20, 15) = 30000.0F;
    image_.at(3, 3) = std::nanf("");
    input_.image = std::as_const(image_).view();
    input_.image_caption = kHostile;
    ExampleLightCurve curve{kHostile, 9.5, {}, {}};
    for (int i = 0; i < 500; ++i) {
      curve.hours.push_back(i * 25.0 / 3600.0);
      curve.deviation.push_back(i == 7 ? std::nanf("") : static_cast<float>(1e-3 * gauss.next()));
    }
    input_.light_curves = {curve, curve, curve};
  }
  [[nodiscard]] const ReportInput& input() const { return input_; }

 private:
  std::vector<TargetMetrics> targets_;
  std::vector<ContaminationRow> contamination_;
  std::vector<BudgetRow> budget_;
  Image<float, unit::Adu> image_;
  ReportInput input_;
};

void collect_error(void* list, xmlErrorPtr error) {
  constexpr int kUnknownTag = 801;  // the parser of libxml2 is older than <section> and <figure>
  if (error->code != kUnknownTag) static_cast<std::vector<std::string>*>(list)->emplace_back(error->message);
}

std::vector<std::string> html_errors(const std::string& page) {
  std::vector<std::string> errors;
  xmlSetStructuredErrorFunc(&errors, collect_error);
  htmlDocPtr document =
      htmlReadMemory(page.data(), static_cast<int>(page.size()), "page", "UTF-8", XML_PARSE_HUGE);  // the same bit
  xmlSetStructuredErrorFunc(nullptr, nullptr);
  if (document == nullptr) errors.emplace_back("no document");
  xmlFreeDoc(document);
  return errors;
}

/// The values of an attribute, in the order of the page.
std::vector<std::string> attribute_values(const std::string& page, const std::string& name) {
  const std::string begin = " " + name + "=\"";
  std::vector<std::string> values;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
    at += begin.size();
    values.push_back(page.substr(at, page.find('"', at) - at));
  }
  return values;
}

TEST(Report, IsOneWellFormedPageWithItsProductsBeside) {
  const test::TemporaryFolder folder;
  const FullReport full;
  const WrittenReport written = write_report(folder.path(), full.input());
  EXPECT_EQ(written.index, folder.path() / "report" / "index.html");
  const std::string page = read_text_file(written.index);
  EXPECT_THAT(html_errors(page), IsEmpty());
  for (const char* product :
       {"analysis/targets.csv", "analysis/noise_vs_magnitude.csv", "analysis/magnitude_recovery.csv",
        "analysis/contamination.csv", "analysis/noise_budget.csv", "report/columns.md", "report/index.html",
        "report/figures/noise_vs_magnitude.gp", "report/figures/noise_points.csv", "report/figures/image.csv"}) {
    EXPECT_THAT(written.products, Contains(std::string(product)));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / product)) << product;
  }
  for (const char* anchor : {"verdict", "noise", "recovery", "contamination", "budget", "images", "flags", "plan",
                             "configuration", "provenance"}) {
    EXPECT_THAT(page, HasSubstr(std::string("id=\"") + anchor + "\"")) << anchor;
  }
}

TEST(Report, EscapesEveryText) {
  const test::TemporaryFolder folder;
  const FullReport full;
  const std::string page = read_text_file(write_report(folder.path(), full.input()).index);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;&amp;&quot;&#39;)&lt;/script&gt;"));
}

TEST(Report, NeedsNothingFromOutside) {
  const test::TemporaryFolder folder;
  const FullReport full;
  const std::string page = read_text_file(write_report(folder.path(), full.input()).index);
  EXPECT_THAT(page, AllOf(Not(HasSubstr("http://")), Not(HasSubstr("https://")), Not(HasSubstr("url("))));
  for (const std::string& source : attribute_values(page, "src")) EXPECT_EQ(source.substr(0, 5), "data:");
}

TEST(Report, LinksOnlyToWhatExists) {
  const test::TemporaryFolder folder;
  const FullReport full;
  const WrittenReport written = write_report(folder.path(), full.input());
  const std::string page = read_text_file(written.index);
  int links = 0;
  for (const std::string& address : attribute_values(page, "href")) {
    if (address[0] == '#' || address == "../config.xml" || address == "../run.json") continue;  // the run writes these
    EXPECT_TRUE(std::filesystem::exists(written.index.parent_path() / address)) << address;
    ++links;
  }
  EXPECT_GT(links, 20);
}

TEST(Report, DrawsEveryFigureWhereGnuplotIs) {
  if (!have_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const test::TemporaryFolder folder;
  const FullReport full;
  const WrittenReport written = write_report(folder.path(), full.input());
  EXPECT_THAT(written.problems, IsEmpty());
  for (const char* name : {"noise_vs_magnitude", "measured_over_predicted", "magnitude_recovery", "contamination",
                           "noise_budget", "image", "light_curves"}) {
    for (const char* ending : {".png", ".svg", ".pdf", ".gp"}) {
      const auto file = folder.path() / "report" / "figures" / (std::string(name) + ending);
      ASSERT_TRUE(std::filesystem::exists(file)) << file;
      EXPECT_GT(std::filesystem::file_size(file), 500U) << file;
    }
  }
}

TEST(Report, SaysWhenGnuplotIsMissingAndIsCompleteOtherwise) {
  const test::TemporaryFolder folder;
  const FullReport full;
  const std::string path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  setenv("PATH", folder.path().c_str(), 1);      // NOLINT(concurrency-mt-unsafe)
  const WrittenReport written = write_report(folder.path(), full.input());
  setenv("PATH", path.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  ASSERT_THAT(written.problems, SizeIs(1));
  EXPECT_THAT(written.problems[0], HasSubstr("gnuplot could not be started"));
  const std::string page = read_text_file(written.index);
  EXPECT_THAT(page, AllOf(HasSubstr("gnuplot could not be started"), Not(HasSubstr("<img"))));
  EXPECT_THAT(html_errors(page), IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "report" / "figures" / "magnitude_recovery.gp"));
}

TEST(Report, OfAnEmptyRunIsStillAPage) {
  const test::TemporaryFolder folder;
  const WrittenReport written = write_report(folder.path(), ReportInput{});
  EXPECT_THAT(written.problems, IsEmpty());
  EXPECT_THAT(html_errors(read_text_file(written.index)), IsEmpty());
}

TEST(Report, OfASingleExposureLeavesOutWhatWasNotMeasured) {
  const test::TemporaryFolder folder;
  std::vector<TargetMetrics> targets = test::synthetic_targets({.stars = 50});
  for (TargetMetrics& t : targets) {
    t.exposures = 1;
    t.bins = 0;
    t.nsr_exposure_measured = t.nsr_1h_measured = t.nsr_1h_within_measured = t.nsr_1h_scaled =
        t.nsr_1h_within_scaled = {};
  }
  ReportInput input;
  input.title = "one exposure";
  input.setup = test::plato_setup();
  input.targets = targets;
  input.verdict = verdict(targets, input.setup, 1.0, plato_requirement(24));
  const WrittenReport written = write_report(folder.path(), input);
  EXPECT_THAT(written.problems, IsEmpty());
  EXPECT_THAT(written.products, Not(Contains(std::string("report/figures/measured_over_predicted.gp"))));
  const std::string page = read_text_file(written.index);
  EXPECT_THAT(page, HasSubstr("noise not measured (too few exposures)"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(Report, ReplacesAnOlderOneAsAWhole) {
  const test::TemporaryFolder folder;
  ReportInput input;
  input.title = "first";
  const auto index = write_report(folder.path(), input).index;
  write_text_file(index.parent_path() / "left-over", "x");
  input.title = "second";
  write_report(folder.path(), input);
  EXPECT_THAT(read_text_file(index), HasSubstr("<h1>second</h1>"));
  EXPECT_FALSE(std::filesystem::exists(index.parent_path() / "left-over"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.partial"));
}

}  // namespace
}  // namespace astroid
