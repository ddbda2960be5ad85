// The synthetic field that is shipped: what the command in its head makes.
#include <gtest/gtest.h>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

TEST(WeekField, IsWhatItsCommandMakes) {
  const StarCatalogue shipped =
      read_catalogue(test::source_dir() / "catalogues/data/week_field_synthetic.csv", {.passband = "V"});
  FieldRequest request;
  request.region = {.centre = {180.0, -70.0}, .width = Degrees(1.9995), .height = Degrees(1.9995)};
  request.bright = Magnitude(3.0);
  request.faint = Magnitude(15.0);
  request.slope = 0.36;
  request.stars = 32240;
  const StarCatalogue made = make_synthetic_field(request);
  ASSERT_EQ(shipped.stars.size(), made.stars.size());
  constexpr double kRounding = 0.5e-6 + 1e-12;  // deg, positions have six decimals; and of the decimal number itself
  for (std::size_t i = 0; i < made.stars.size(); ++i) {
    EXPECT_EQ(shipped.stars[i].id, made.stars[i].id);
    EXPECT_EQ(shipped.stars[i].magnitude, made.stars[i].magnitude);
    EXPECT_NEAR(shipped.stars[i].sky.ra, made.stars[i].sky.ra, kRounding);
    EXPECT_NEAR(shipped.stars[i].sky.dec, made.stars[i].sky.dec, kRounding);
  }
}

}  // namespace
}  // namespace astroid
