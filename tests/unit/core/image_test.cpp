#include "astroid/core/image.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace astroid {
namespace {

TEST(Image, IsAddressedByDetectorCoordinates) {
  Image<double, unit::Adu> image(Rectangle{10, -2, 3, 2});
  image.at(12, -1) = 7.0;
  EXPECT_EQ(image.row(-1)[2], 7.0);
  EXPECT_EQ(image.pixels()[5], 7.0);
}

TEST(Image, DoesNotCopyImplicitly) {
  static_assert(!std::is_copy_constructible_v<Image<double, unit::Adu>>);
  static_assert(std::is_nothrow_move_constructible_v<Image<double, unit::Adu>>);
  static_assert(!std::is_convertible_v<ImageView<const double, unit::Adu>, ImageView<double, unit::Adu>>);
}

TEST(PixelLayout, LaysRegionsOneAfterTheOther) {
  const PixelLayout layout({{0, 0, 4, 2}, {100, 50, 3, 3}});
  EXPECT_EQ(layout.size(), 17U);
  EXPECT_EQ(layout.index(1, 101, 51), 8U + 3U + 1U);
}

TEST(Rectangle, IntersectsToNothingWhenApart) {
  EXPECT_TRUE(intersect({0, 0, 4, 4}, {4, 0, 2, 2}).empty());
  EXPECT_EQ(intersect({0, 0, 4, 4}, {2, 3, 9, 9}), (Rectangle{2, 3, 2, 1}));
}

}  // namespace
}  // namespace astroid
