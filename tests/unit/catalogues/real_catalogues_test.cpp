// Catalogues that other programs wrote, and the one that is shipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "astroid/catalogues/catalogue_reader.hpp"
#include "astroid/test/temporary_folder.hpp"

namespace astroid {
namespace {

struct RealCatalogue {
  std::string file;
  std::string stated;    ///< passband
  std::string passband;  ///< as read
  std::string colour_index;
  std::size_t stars;
  double brightest;
  double faintest;
};

void PrintTo(const RealCatalogue& real, std::ostream* out) {
  *out << real.file;
}

class RealCatalogues : public testing::TestWithParam<RealCatalogue> {};

TEST_P(RealCatalogues, AreReadWhole) {
  const RealCatalogue& real = GetParam();
  const auto path = test::shared_data("catalogues/" + real.file);
  if (!path) GTEST_SKIP() << "shared data folder is absent";
  const StarCatalogue catalogue = read_catalogue(*path, {.passband = real.stated, .leave_out_missing = true});
  EXPECT_EQ(catalogue.passband, real.passband);
  EXPECT_EQ(catalogue.colour_index, real.colour_index);
  ASSERT_EQ(catalogue.stars.size(), real.stars);
  const auto [brightest, faintest] =
      std::minmax_element(catalogue.stars.begin(), catalogue.stars.end(),
                          [](const auto& a, const auto& b) { return a.magnitude < b.magnitude; });
  EXPECT_NEAR(brightest->magnitude.value(), real.brightest, 5e-4);
  EXPECT_NEAR(faintest->magnitude.value(), real.faintest, 5e-4);
  std::set<std::string> ids;
  for (const CatalogueStar& star : catalogue.stars) ids.insert(star.id);
  EXPECT_EQ(ids.size(), catalogue.stars.size());
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealCatalogues,
    testing::Values(RealCatalogue{"tycho2_lops2_8deg.csv", "V_T", "V_T", "", 11840, 3.050, 13.910},
                    RealCatalogue{"tycho2_carina_plane_2deg.csv", "VT", "V_T", "", 899, 3.882, 11.288},
                    RealCatalogue{"kstars_hip_allsky_V_BV.csv", "V", "V", "B-V", 125982, -1.440, 8.990},
                    RealCatalogue{"asteca_field.csv", "", "G", "BP-RP", 8683, 7.632, 18.500},
                    RealCatalogue{"asteca_cluster_old.csv", "G", "G", "BP-RP", 1998, 4.299, 18.992},
                    RealCatalogue{"gaia_ngc2516_G19.csv", "G", "G", "BP-RP", 1998, 4.299, 18.992},
                    RealCatalogue{"gaiadr3_plane_G18.5.csv", "G", "G", "BP-RP", 8683, 7.632, 18.500},
                    RealCatalogue{"refcat2_ey_uma.ecsv", "", "G", "BP-RP", 187, 7.788, 20.277},
                    RealCatalogue{"apass_ey_uma.ecsv", "V", "V", "B-V", 51, 11.267, 17.024},
                    RealCatalogue{"spitzer_glimpse_irac2.csv", "IRAC2", "IRAC2", "", 224, 6.513, 8.881},
                    RealCatalogue{"platosim_starcatalogOld.txt", "V", "V", "", 32240, 2.797, 15.000}),
    [](const auto& parameter) {
      std::string name = parameter.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '.' || c == '-'; }, '_');
      return name;
    });

TEST(ShippedCatalogue, IsTheLops2FieldOfTycho2) {
  const StarCatalogue catalogue =
      read_catalogue(test::source_dir() / "catalogues/data/tycho2_lops2_8deg.csv", {.passband = "V_T"});
  EXPECT_EQ(catalogue.stars.size(), 11840U);
  EXPECT_EQ(catalogue.stars.front().magnitude.value(), 3.050);
}

TEST(PlatosimCatalogue, IsTheSameAsBareTextAndAsCsv) {
  const auto bare = test::shared_data("catalogues/platosim_starcatalogOld.txt");
  const auto named = test::shared_data("catalogues/platosim_pic11_field_V15.csv");
  if (!bare || !named) GTEST_SKIP() << "shared data folder is absent";
  const StarCatalogue a = read_catalogue(*bare, {.passband = "V"});
  const StarCatalogue b = read_catalogue(*named, {.passband = "V"});
  ASSERT_EQ(a.stars.size(), b.stars.size());
  for (std::size_t i = 0; i < a.stars.size(); ++i) {
    ASSERT_EQ(a.stars[i].id, b.stars[i].id);
    ASSERT_EQ(a.stars[i].magnitude, b.stars[i].magnitude);
  }
}

}  // namespace
}  // namespace astroid
