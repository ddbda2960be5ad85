// Hard case N20: blooming conserves charge.
#include "astroid/sim/blooming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "astroid/core/frame.hpp"

namespace astroid {
namespace {

struct Bloomed {
  std::vector<double> column;
  double lost;
};

Bloomed bloom_column(const std::vector<double>& column, double full_well) {
  Image<double, unit::SampledElectrons> image(1, static_cast<int>(column.size()));
  std::copy(column.begin(), column.end(), image.pixels().begin());
  const double lost = bloom(image.view(), full_well);
  return {{image.pixels().begin(), image.pixels().end()}, lost};
}

double sum(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

TEST(Blooming, LosesHalfOfTheExcessAtANearEdge) {
  std::vector<double> column(8, 0.0);
  column[0] = 5.0;
  const Bloomed result = bloom_column(column, 1.0);
  EXPECT_DOUBLE_EQ(result.lost, 2.0);
  EXPECT_EQ(result.column, (std::vector<double>{1, 1, 1, 0, 0, 0, 0, 0}));
}

TEST(Blooming, SpillsAlongTheColumnAsFarAsThereIsRoom) {
  std::vector<double> column(20, 0.0);
  column.insert(column.end(), {10.0, 40.0, 10.0});
  column.resize(63, 0.0);
  const Bloomed result = bloom_column(column, 1.0);
  EXPECT_DOUBLE_EQ(result.lost, 8.5);
  EXPECT_DOUBLE_EQ(sum(result.column), 51.5);
  for (const double pixel : result.column) EXPECT_LE(pixel, 1.0);
}

TEST(Blooming, ConservesChargeInAnyColumn) {
  std::vector<double> column(400);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = static_cast<double>((i * 2654435761U) % 1000003U) * 3.7;
  const Bloomed result = bloom_column(column, 1.2e6);
  const double before = sum(column);
  EXPECT_NEAR(sum(result.column) + result.lost, before, 1e-12 * before);
  EXPECT_GT(result.lost, 0.0);
  for (const double pixel : result.column) EXPECT_LE(pixel, 1.2e6);
}

TEST(Blooming, LeavesAColumnWithoutExcessAlone) {
  const std::vector<double> column{0.1, 0.2, 0.3, 1.0, -0.4};
  const Bloomed result = bloom_column(column, 1.0);
  EXPECT_EQ(result.column, column);
  EXPECT_EQ(result.lost, 0.0);
}

TEST(Blooming, FlagsEveryPixelThatSpiltOrReceived) {
  Image<double, unit::SampledElectrons> image(1, 7);
  image.at(0, 3) = 4.0;  // 3 too many: 1.5 each way fill one neighbour and half of the next
  image.at(0, 0) = 0.25;
  Image<std::uint8_t, unit::Flags> flags(1, 7);
  const ImageView<std::uint8_t, unit::Flags> view = flags.view();
  EXPECT_EQ(bloom(image.view(), 1.0, &view), 0.0);
  const std::vector<std::uint8_t> expected{0,
                                           pixel_flag::kFullWell,
                                           pixel_flag::kFullWell,
                                           pixel_flag::kFullWell,
                                           pixel_flag::kFullWell,
                                           pixel_flag::kFullWell,
                                           0};
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), flags.pixels().begin()));
  EXPECT_DOUBLE_EQ(image.at(0, 1), 0.5);
}

/// Every pixel of every column, both ways: what bloom() does while it looks only where charge goes.
double bloom_everywhere(Image<double, unit::SampledElectrons>& image, double full_well,
                        Image<std::uint8_t, unit::Flags>& flags) {
  double lost = 0.0;
  for (int x = 0; x < image.nx(); ++x) {
    std::vector<double> half_excess(static_cast<std::size_t>(image.ny()), 0.0);
    bool any = false;
    for (int y = 0; y < image.ny(); ++y) {
      if (image.at(x, y) < full_well) continue;
      any = true;
      half_excess[static_cast<std::size_t>(y)] = 0.5 * (image.at(x, y) - full_well);
      image.at(x, y) = full_well;
      flags.at(x, y) = pixel_flag::kFullWell;
    }
    if (!any) continue;
    double sum_of_ways = 0.0;
    for (const bool up : {true, false}) {
      double carried = 0.0;
      for (int i = 0; i < image.ny(); ++i) {
        const int y = up ? i : image.ny() - 1 - i;
        double& pixel = image.at(x, y);
        if (carried > 0.0) {
          flags.at(x, y) = pixel_flag::kFullWell;
          if (pixel < full_well) {
            const double taken = std::min(full_well - pixel, carried);
            pixel = taken == carried ? pixel + carried : full_well;
            carried -= taken;
          }
        }
        carried += half_excess[static_cast<std::size_t>(y)];
      }
      sum_of_ways += carried;
    }
    lost += sum_of_ways;
  }
  return lost;
}

TEST(Blooming, LooksOnlyWhereChargeGoesAndDoesTheSame) {
  for (const double crowd : {0.002, 0.02, 0.3}) {
    Image<double, unit::SampledElectrons> image(37, 211);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const double u = static_cast<double>((i * 2654435761U) % 1000003U) / 1000003.0;
      const double v = static_cast<double>((i * 40503U + 7U) % 65537U) / 65537.0;
      image.pixels()[i] = u < crowd ? 1e6 * (0.9 + 3.0 * v) : 9e5 * v;
    }
    image.at(3, 100) = 1e6;  // exactly full
    Image<double, unit::SampledElectrons> plain(37, 211);
    std::ranges::copy(image.pixels(), plain.pixels().begin());
    Image<std::uint8_t, unit::Flags> flags(37, 211);
    Image<std::uint8_t, unit::Flags> plain_flags(37, 211);
    const ImageView<std::uint8_t, unit::Flags> view = flags.view();
    EXPECT_EQ(bloom(image.view(), 1e6, &view), bloom_everywhere(plain, 1e6, plain_flags));
    EXPECT_TRUE(std::ranges::equal(image.pixels(), plain.pixels())) << crowd;
    EXPECT_TRUE(std::ranges::equal(flags.pixels(), plain_flags.pixels())) << crowd;
  }
}

TEST(FullWellClip, CountsWhatItRemoves) {
  Image<double, unit::SampledElectrons> image(2, 1);
  image.at(0, 0) = 5.0;
  image.at(1, 0) = 0.5;
  EXPECT_DOUBLE_EQ(clip_full_well(image.view(), 1.0), 4.0);
  EXPECT_EQ(image.at(0, 0), 1.0);
  EXPECT_EQ(image.at(1, 0), 0.5);
}

}  // namespace
}  // namespace astroid
