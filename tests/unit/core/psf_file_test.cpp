#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "astroid/core/distortion.hpp"
#include "astroid/core/fits.hpp"
#include "astroid/core/psf.hpp"
#include "astroid/test/psf_table.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using testing::HasSubstr;

class PsfFile : public testing::Test {
 protected:
  // A PSF of 4 x 3 samples with these keywords.
  std::string write(const std::vector<FitsCard>& cards,
                    const std::vector<double>& samples = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) {
    const std::string path = (folder_.path() / "psf.fits").string();
    FitsWriter fits(path);
    fits.begin_image(FitsNumber::kFloat64, {4, 3});
    fits.cards(cards);
    fits.write_pixels(0, std::span<const double>(samples));
    fits.commit();
    return path;
  }

  std::string refusal(const std::vector<FitsCard>& cards) {
    const std::string path = write(cards);
    try {
      static_cast<void>(read_psf_table(path));
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
      return error.what();
    }
    return "accepted";
  }

  test::TemporaryFolder folder_;
};

TEST_F(PsfFile, GivesScaleAndOrigin) {
  const PsfTable table = read_psf_table(write({{"SUBPIX", 8}, {"CRPIX1", 2.0}, {"CRPIX2", 1.5}}));
  EXPECT_EQ(table.samples.nx(), 4);
  EXPECT_EQ(table.samples.ny(), 3);
  EXPECT_EQ(table.samples.at(1, 2), 10.0);
  EXPECT_EQ(table.samples_per_pixel, 8.0);
  EXPECT_EQ(table.centre_x, 1.0);
  EXPECT_EQ(table.centre_y, 0.5);
}

TEST_F(PsfFile, IsCentredUnlessItSaysOtherwise) {
  const PsfTable table = read_psf_table(write({{"PIXSAMP", 4.0}}));
  EXPECT_EQ(table.samples_per_pixel, 4.0);
  EXPECT_EQ(table.centre_x, 1.5);
  EXPECT_EQ(table.centre_y, 1.0);
}

TEST_F(PsfFile, MayGiveItsStepInPixels) {
  EXPECT_EQ(read_psf_table(write({{"CDELT1", 0.125}, {"CDELT2", 0.125}})).samples_per_pixel, 8.0);
}

TEST_F(PsfFile, IsRefusedWithoutAScale) {
  EXPECT_THAT(refusal({}), HasSubstr("SUBPIX: the scale of the PSF table is missing; expected samples per pixel"));
  EXPECT_THAT(refusal({{"SUBPIX", -2}}), HasSubstr("SUBPIX = -2: the scale of the PSF table is not usable"));
  EXPECT_THAT(refusal({{"CDELT1", 0.0}}), HasSubstr("CDELT1 = 0"));
}

TEST_F(PsfFile, IsRefusedWithAStepInDegreesOrOblongSamples) {
  const std::string text = refusal({{"CDELT1", 0.125}, {"CDELT2", 0.25}, {"CUNIT1", "deg"}});
  EXPECT_THAT(text, HasSubstr("CUNIT1 = deg: the step of the PSF table is not in pixels"));
  EXPECT_THAT(text, HasSubstr("CDELT2 = 0.25: the samples of the PSF table are not square"));
}

TEST_F(PsfFile, IsRefusedWithItsOriginOutside) {
  EXPECT_THAT(refusal({{"SUBPIX", 8}, {"CRPIX1", 0.0}}), HasSubstr("CRPIX1 = 0: the origin of the PSF is outside"));
}

TEST_F(PsfFile, IsRefusedWithHoles) {
  std::vector<double> samples(12, 1.0);
  samples[5] = std::numeric_limits<double>::quiet_NaN();
  const std::string path = write({{"SUBPIX", 8}}, samples);
  EXPECT_THROW(static_cast<void>(read_psf_table(path)), InputError);
}

TEST_F(PsfFile, ThatIsMissingIsAProblemOfTheEnvironment) {
  EXPECT_THROW(static_cast<void>(read_psf_table((folder_.path() / "nowhere.fits").string())), EnvironmentError);
}

TEST_F(PsfFile, RendersAsTheTableInMemory) {
  const PsfTable table = test::gaussian_psf_table(0.6, 8.0, 3.0);
  const std::string path = (folder_.path() / "gaussian.fits").string();
  FitsWriter fits(path);
  fits.begin_image(FitsNumber::kFloat64, {table.samples.nx(), table.samples.ny()});
  fits.card({"SUBPIX", 8});
  fits.write_pixels(0, table.samples.pixels());
  fits.commit();
  std::vector<double> memory(49);
  std::vector<double> file(49);
  make_prf_psf(table, 1e-5)->integrate({0.3, 0.4}, {-3, -3, 7, 7}, memory);
  make_prf_psf(read_psf_table(path), 1e-5)->integrate({0.3, 0.4}, {-3, -3, 7, 7}, file);
  EXPECT_EQ(memory, file);
}

TEST_F(PsfFile, OfAFieldHoldsTablesAndTheirPlaces) {
  const std::string path = (folder_.path() / "field.fits").string();
  const std::vector<double> samples(16, 1.0);
  {
    FitsWriter fits(path);
    for (const double x : {10.5, 400.0}) {
      fits.begin_image(FitsNumber::kFloat64, {4, 4});
      fits.cards(std::vector<FitsCard>{{"SUBPIX", 2}, {"FIELDX", x}, {"FIELDY", 2.0 * x}});
      fits.write_pixels(0, std::span<const double>(samples));
    }
    fits.commit();
  }
  const auto tables = read_field_psf(path);
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[0].position.x, 10.5);
  EXPECT_EQ(tables[1].position.y, 800.0);
  EXPECT_EQ(tables[1].table.samples_per_pixel, 2.0);
  EXPECT_EQ(tables[1].table.centre_x, 1.5);
}

TEST_F(PsfFile, OfAFieldWithoutPlacesIsRefused) {
  const std::string path = write({{"SUBPIX", 2}, {"FIELDX", 1.0}});
  try {
    static_cast<void>(read_field_psf(path));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("FIELDY"));
    EXPECT_THAT(error.what(), HasSubstr("has no place"));
  }
}

TEST_F(PsfFile, OfSipCoefficientsIsReadFromItsHeader) {
  const SipPolynomial sip =
      read_sip_polynomial(write({{"A_ORDER", 3}, {"B_ORDER", 2}, {"A_2_0", 1e-6}, {"A_1_2", -2e-9}, {"B_1_1", 3e-6}}));
  EXPECT_EQ(sip.order, 3);
  EXPECT_EQ(sip.a[sip.index(2, 0)], 1e-6);
  EXPECT_EQ(sip.a[sip.index(1, 2)], -2e-9);
  EXPECT_EQ(sip.b[sip.index(1, 1)], 3e-6);
  EXPECT_EQ(sip.b[sip.index(0, 3)], 0.0);
}

TEST_F(PsfFile, OfUnusableSipCoefficientsIsRefused) {
  const auto refusal_of = [&](const std::vector<FitsCard>& cards) -> std::string {
    try {
      static_cast<void>(read_sip_polynomial(write(cards)));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal_of({{"A_ORDER", 2}}), HasSubstr("B_ORDER"));
  EXPECT_THAT(refusal_of({{"A_ORDER", 1}, {"B_ORDER", 12}}), HasSubstr("A_ORDER = 1"));
  EXPECT_THAT(refusal_of({{"A_ORDER", 2}, {"B_ORDER", 2}, {"B_1_0", 0.1}}), HasSubstr("B_1_0"));
}

}  // namespace
}  // namespace astroid
