#include "astroid/test/psf_table.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "astroid/core/psf.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

std::string refusal(const PsfTable& table, int phases = 0) {
  try {
    static_cast<void>(make_prf_psf(table, 1e-6, phases));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PrfPsf, RefusesATableWithoutFlux) {
  PsfTable table = test::gaussian_psf_table(0.6, 4.0, 2.0);
  table.samples.at(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(table), HasSubstr("finite samples with a positive sum"));
  std::ranges::fill(table.samples.pixels(), 0.0);
  EXPECT_THAT(refusal(table), HasSubstr("cannot be normalised"));
}

TEST(PrfPsf, NamesEverythingThatIsWrong) {
  PsfTable table;
  table.samples_per_pixel = 0.0;
  table.centre_x = 3.0;
  const std::string text = refusal(table);
  EXPECT_THAT(text, HasSubstr("too small"));
  EXPECT_THAT(text, HasSubstr("no scale"));
  EXPECT_THAT(text, HasSubstr("outside the table"));
}

TEST(PrfPsf, RefusesALibraryThatFillsTheMemory) {
  const PsfTable table = test::gaussian_psf_table(0.6, 4.0, 4.0);
  EXPECT_THAT(refusal(table, 5000), HasSubstr("PSF/Phases = 5000"));
  EXPECT_THAT(refusal(table, -1), HasSubstr("PSF/Phases"));
  EXPECT_EQ(refusal(table, 1), "accepted");
}

TEST(PrfPsf, SaysWhatItIs) {
  const auto psf = make_prf_psf(test::gaussian_psf_table(0.6, 4.0, 2.0), 1e-6, 8);
  EXPECT_THAT(psf->description(), HasSubstr("table of 16 x 16 samples, 4 per px; library of 8 x 8 phases"));
}

TEST(PrfPsf, MarksPixelsOfAStarWithoutAPosition) {
  std::vector<double> p(4);
  make_prf_psf(test::gaussian_psf_table(0.6, 4.0, 2.0), 1e-3)
      ->integrate({std::numeric_limits<double>::infinity(), 0.0}, {0, 0, 2, 2}, p);
  for (const double value : p) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace astroid
