#include "sub_pixel/tile_grid.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr double kMegabyte = 1e6;

TEST(TileGrid, CoversEveryPixelOnce) {
  for (const Rectangle detector :
       {Rectangle{0, 0, 1, 1}, Rectangle{0, 0, 1, 300}, Rectangle{0, 0, 257, 64}, Rectangle{0, 0, 1000, 700}}) {
    for (const double memory : {2.0, 20.0, 200.0}) {
      const auto grid =
          detail::make_tile_grid(detector, {.sub_pixels = 4, .margin = 6, .memory_bytes = memory * kMegabyte});
      std::vector<int> times(detector.size());
      for (const Rectangle& tile : grid.tiles)
        for (int y = tile.y0; y < tile.y1(); ++y)
          for (int x = tile.x0; x < tile.x1(); ++x) ++times[static_cast<std::size_t>(y * detector.nx + x)];
      for (const int n : times) EXPECT_EQ(n, 1);
    }
  }
}

TEST(TileGrid, FitsIntoTheMemory) {
  for (const double memory : {2.0, 20.0, 200.0}) {
    const auto grid =
        detail::make_tile_grid({0, 0, 2000, 1500}, {.sub_pixels = 8, .margin = 4, .memory_bytes = memory * kMegabyte});
    EXPECT_LE(grid.workspace_bytes, memory * kMegabyte);
    EXPECT_GE(grid.period_x, grid.tile_x + 8);
    EXPECT_GE(grid.period_y, grid.tile_y + 8);
  }
}

TEST(TileGrid, TakesOneTileWhereThatFits) {
  EXPECT_EQ(detail::make_tile_grid({0, 0, 88, 88}, {.sub_pixels = 4, .margin = 6, .memory_bytes = 1e9}).tiles.size(),
            1U);
}

TEST(TileGrid, SaysWhatTheSmallestTileNeeds) {
  try {
    detail::make_tile_grid({0, 0, 100, 100}, {.sub_pixels = 64, .margin = 40, .memory_bytes = 1e6});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the smallest tile needs"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace astroid
