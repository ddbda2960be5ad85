// Star counts of synthetic and of extended fields follow their law: chi^2 against the expected numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

constexpr double kBin = 0.25;  // mag

std::vector<double> counts_of(const StarCatalogue& catalogue, double from, double to) {
  std::vector<double> counts(static_cast<std::size_t>(std::lround((to - from) / kBin)));
  for (const CatalogueStar& star : catalogue.stars) {
    const double bin = (star.magnitude.value() - from) / kBin;
    if (bin >= 0.0 && bin < static_cast<double>(counts.size())) counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  return counts;
}

/// chi^2 as a number of standard deviations from its mean: about normal for many bins.
double chi_squared_z(const std::vector<double>& counts, const std::vector<double>& expected) {
  double chi_squared = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    chi_squared += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  const auto freedom = static_cast<double>(counts.size());
  return (chi_squared - freedom) / std::sqrt(2.0 * freedom);
}

/// The law scale 10^(slope (m - anchor)) and the magnitudes between which it is counted.
struct CountedLaw {
  double scale;
  double slope;
  double anchor;
  double from;
  double to;
};

std::vector<double> law_in_bins(const CountedLaw& law) {
  const auto brighter = [&](double m) { return law.scale * std::pow(10.0, law.slope * (m - law.anchor)); };
  std::vector<double> expected(static_cast<std::size_t>(std::lround((law.to - law.from) / kBin)));
  for (std::size_t bin = 0; bin < expected.size(); ++bin) {
    const double low = law.from + kBin * static_cast<double>(bin);
    expected[bin] = brighter(low + kBin) - brighter(low);
  }
  return expected;
}

FieldRequest large_field() {
  FieldRequest request;
  request.region.centre = {95.3104, -47.8869};
  request.region.radius = Degrees(10.0);
  request.density = 60.0;
  request.density_limit = Magnitude(12.0);
  request.bright = Magnitude(9.0);
  request.faint = Magnitude(14.0);
  return request;
}

TEST(CountLaw, HoldsInASyntheticFieldOfGivenDensity) {
  constexpr double kLimit = 4.0;  // standard deviations
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    FieldRequest request = large_field();
    request.seed = seed;
    const double scale = 60.0 * square_degrees(request.region);
    const double z = chi_squared_z(counts_of(make_synthetic_field(request), 9.0, 14.0),
                                   law_in_bins({scale, request.slope, 12.0, 9.0, 14.0}));
    RecordProperty("z", std::to_string(z));
    EXPECT_LT(std::abs(z), kLimit) << "seed " << seed;
  }
}

TEST(CountLaw, HoldsInASyntheticFieldOfGivenNumber) {
  constexpr double kLimit = 4.0;  // standard deviations
  FieldRequest request = large_field();
  request.density.reset();
  request.stars = 100000;
  request.slope = 0.5;
  const double scale = 1e5 / (1.0 - std::pow(10.0, 0.5 * (9.0 - 14.0)));
  const double z =
      chi_squared_z(counts_of(make_synthetic_field(request), 9.0, 14.0), law_in_bins({scale, 0.5, 14.0, 9.0, 14.0}));
  EXPECT_LT(std::abs(z), kLimit);
}

TEST(CountLaw, NumberOfStarsIsPoissonian) {
  // 200 fields of about 100 stars: the variance of the number is its mean, to four of its standard errors.
  FieldRequest request = large_field();
  request.region.radius = Degrees(1.0);
  request.faint = Magnitude(11.65);
  constexpr int kFields = 200;
  double sum = 0.0;
  double squares = 0.0;
  for (int seed = 1; seed <= kFields; ++seed) {
    request.seed = static_cast<std::uint64_t>(seed);
    const auto stars = static_cast<double>(make_synthetic_field(request).stars.size());
    sum += stars;
    squares += stars * stars;
  }
  const double expected =
      60.0 * square_degrees(request.region) *
      (std::pow(10.0, request.slope * (11.65 - 12.0)) - std::pow(10.0, request.slope * (9.0 - 12.0)));
  const double mean = sum / kFields;
  const double variance = (squares - sum * mean) / (kFields - 1);
  EXPECT_NEAR(mean, expected, 4.0 * std::sqrt(expected / kFields));
  EXPECT_NEAR(variance / expected, 1.0, 4.0 * std::sqrt(2.0 / kFields));
}

TEST(CountLaw, HoldsInAnExtendedField) {
  constexpr double kLimit = 4.0;  // standard deviations
  FieldRequest request = large_field();
  StarCatalogue field = make_synthetic_field(request);
  std::size_t n = 0;
  std::erase_if(field.stars, [&n](const auto& star) { return star.magnitude > Magnitude(12.0) && ++n % 3 != 0; });
  const ExtensionLaw law = extend_catalogue(
      field,
      {.region = request.region, .complete_to = Magnitude(12.0), .slope = {}, .faint = Magnitude(16.0), .seed = 9});
  EXPECT_NEAR(law.slope, request.slope, 4.0 * law.slope_error);
  const double z = chi_squared_z(counts_of(field, 12.0, 16.0),
                                 law_in_bins({static_cast<double>(law.stars), law.slope, 12.0, 12.0, 16.0}));
  EXPECT_LT(z, kLimit);
}

TEST(CountLaw, ExtendsTheShippedFieldOfTycho) {
  StarCatalogue field =
      read_catalogue(test::source_dir() / "catalogues/data/tycho2_lops2_8deg.csv", {.passband = "V_T"});
  const std::size_t before = field.stars.size();
  SkyRegion region;
  region.centre = {95.3104, -47.8869};
  region.radius = Degrees(8.0);
  const ExtensionLaw law = extend_catalogue(
      field, {.region = region, .complete_to = Magnitude(11.0), .slope = {}, .faint = Magnitude(15.0)});
  RecordProperty("slope", std::to_string(law.slope));
  EXPECT_GT(law.slope, 0.3);  // counts of the sky near V = 10: 0.45 (Cox 2000), falling to 0.3 at V = 15
  EXPECT_LT(law.slope, 0.55);
  EXPECT_EQ(field.stars.size(), before + static_cast<std::size_t>(law.added));
  const double expected = static_cast<double>(law.stars) * std::pow(10.0, law.slope * 4.0);
  EXPECT_NEAR(static_cast<double>(field.stars.size()), expected, 5.0 * std::sqrt(expected));
}

}  // namespace
}  // namespace astroid
