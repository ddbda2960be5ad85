#include "astroid/catalogues/synthetic_field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/core/error.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

using testing::Contains;
using testing::HasSubstr;

FieldRequest small_field() {
  FieldRequest request;
  request.region.centre = {95.0, -48.0};
  request.region.radius = Degrees(2.0);
  request.density = 50.0;
  request.faint = Magnitude(13.0);
  return request;
}

void expect_same_star(const CatalogueStar& a, const CatalogueStar& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.sky.ra, b.sky.ra);
  EXPECT_EQ(a.sky.dec, b.sky.dec);
  EXPECT_EQ(a.magnitude, b.magnitude);
}

TEST(SyntheticField, IsTheSameForTheSameSeedOnly) {
  FieldRequest request = small_field();
  const StarCatalogue a = make_synthetic_field(request);
  const StarCatalogue b = make_synthetic_field(request);
  ASSERT_EQ(a.stars.size(), b.stars.size());
  for (std::size_t i = 0; i < a.stars.size(); ++i) expect_same_star(a.stars[i], b.stars[i]);
  request.seed = 2;
  EXPECT_NE(make_synthetic_field(request).stars.front().sky.ra, a.stars.front().sky.ra);
}

TEST(SyntheticField, FirstStarHasTheAddressedRandomNumbers) {
  // Golden, computed by an independent program: guards the layout of the random numbers, which is a promise.
  const StarCatalogue field = make_synthetic_field(small_field());
  EXPECT_EQ(field.stars.front().id, "syn1-1");
  EXPECT_EQ(field.stars.front().sky.ra, 96.03361325);
  EXPECT_EQ(field.stars.front().sky.dec, -48.09144168);
  EXPECT_EQ(field.stars.front().magnitude.value(), 6.3322);
}

TEST(SyntheticField, FainterLimitAppendsStarsAndChangesNone) {
  FieldRequest request = small_field();
  const StarCatalogue shallow = make_synthetic_field(request);
  request.faint = Magnitude(15.0);
  const StarCatalogue deep = make_synthetic_field(request);
  ASSERT_GT(deep.stars.size(), 2 * shallow.stars.size());
  for (std::size_t i = 0; i < shallow.stars.size(); ++i) expect_same_star(shallow.stars[i], deep.stars[i]);
  EXPECT_GT(deep.stars[shallow.stars.size()].magnitude.value(), 13.0);
}

TEST(SyntheticField, HasExactlyTheNumberAskedFor) {
  FieldRequest request = small_field();
  request.density.reset();
  request.stars = 1234;
  const StarCatalogue field = make_synthetic_field(request);
  ASSERT_EQ(field.stars.size(), 1234U);
  EXPECT_TRUE(std::is_sorted(field.stars.begin(), field.stars.end(),
                             [](const auto& a, const auto& b) { return a.magnitude < b.magnitude; }));
  EXPECT_GE(field.stars.front().magnitude, request.bright);
  EXPECT_LE(field.stars.back().magnitude, request.faint);
}

TEST(SyntheticField, StatesItsLaw) {
  const StarCatalogue field = make_synthetic_field(small_field());
  EXPECT_THAT(field.notes, Contains(HasSubstr("50 10^(0.35 (m - 12)), less those brighter than 6; seed 1")));
}

TEST(SyntheticField, ReportsEveryProblemOfARequest) {
  FieldRequest request = small_field();
  request.slope = -1.0;
  request.bright = Magnitude(20.0);
  request.density.reset();
  try {
    (void)make_synthetic_field(request);
    FAIL() << "made";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
}

TEST(SyntheticField, RefusesMoreStarsThanAnyoneCanWant) {
  FieldRequest request = small_field();
  request.faint = Magnitude(40.0);
  EXPECT_THROW((void)make_synthetic_field(request), InputError);
}

TEST(SyntheticField, RefusesEmptyRegions) {
  FieldRequest request = small_field();
  request.region.radius = Degrees(0.0);
  EXPECT_THROW((void)make_synthetic_field(request), InputError);
  request.region.radius = Degrees(-1.0);
  EXPECT_THROW((void)make_synthetic_field(request), InputError);
}

/// A field that is complete to V = 12 and lacks ever more stars from there on.
StarCatalogue incomplete_field() {
  FieldRequest request = small_field();
  request.region.radius = Degrees(8.0);
  StarCatalogue field = make_synthetic_field(request);
  std::size_t n = 0;
  std::erase_if(field.stars,
                [&n](const CatalogueStar& star) { return star.magnitude > Magnitude(12.0) && ++n % 4 != 0; });
  return field;
}

TEST(ExtendCatalogue, KeepsTheStarsOfTheCatalogue) {
  const StarCatalogue before = incomplete_field();
  StarCatalogue after = incomplete_field();
  const ExtensionLaw law =
      extend_catalogue(after, {.region = {}, .complete_to = Magnitude(12.0), .slope = {}, .faint = Magnitude(15.0)});
  ASSERT_EQ(after.stars.size(), before.stars.size() + static_cast<std::size_t>(law.added));
  for (std::size_t i = 0; i < before.stars.size(); ++i) expect_same_star(before.stars[i], after.stars[i]);
  std::set<std::string> ids;
  for (const CatalogueStar& star : after.stars) ids.insert(star.id);
  EXPECT_EQ(ids.size(), after.stars.size());
  for (std::size_t i = before.stars.size(); i < after.stars.size(); ++i) {
    EXPECT_GT(after.stars[i].magnitude.value(), 12.0);
    EXPECT_LE(after.stars[i].magnitude.value(), 15.0);
    EXPECT_TRUE(contains(law.region, after.stars[i].sky));
  }
}

TEST(ExtendCatalogue, FainterLimitAppendsStarsAndChangesNone) {
  StarCatalogue shallow = incomplete_field();
  StarCatalogue deep = incomplete_field();
  (void)extend_catalogue(shallow,
                         {.region = {}, .complete_to = Magnitude(12.0), .slope = 0.35, .faint = Magnitude(13.6)});
  (void)extend_catalogue(deep, {.region = {}, .complete_to = Magnitude(12.0), .slope = 0.35, .faint = Magnitude(15.3)});
  ASSERT_GT(deep.stars.size(), shallow.stars.size());
  for (std::size_t i = 0; i < shallow.stars.size(); ++i) expect_same_star(shallow.stars[i], deep.stars[i]);
}

TEST(ExtendCatalogue, StatesTheLawAndWarnsOfAnEstimatedLimit) {
  StarCatalogue field = incomplete_field();
  const ExtensionLaw law =
      extend_catalogue(field, {.region = {}, .complete_to = {}, .slope = {}, .faint = Magnitude(15.0)});
  EXPECT_EQ(law.complete_to.value(), 11.75);  // the bin that ends at 12 is the fullest
  EXPECT_THAT(field.notes, Contains(HasSubstr("WARNING: complete to")));
  EXPECT_THAT(field.notes, Contains(HasSubstr("extended: " + std::to_string(law.added) + " stars added in V")));
}

TEST(ExtendCatalogue, RefusesWhatHasNoLaw) {
  StarCatalogue few = incomplete_field();
  few.stars.resize(10);
  EXPECT_THROW((void)extend_catalogue(
                   few, {.region = {}, .complete_to = Magnitude(12.0), .slope = {}, .faint = Magnitude(15.0)}),
               InputError);
  StarCatalogue pixels = incomplete_field();
  pixels.positions = PositionKind::kPixel;
  EXPECT_THROW((void)extend_catalogue(pixels, {.region = {}, .complete_to = {}, .slope = {}, .faint = Magnitude(15.0)}),
               InputError);
  StarCatalogue none;
  EXPECT_THROW((void)extend_catalogue(none, {.region = {}, .complete_to = {}, .slope = {}, .faint = Magnitude(15.0)}),
               InputError);
}

}  // namespace
}  // namespace astroid
