#include "cell_grid.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace astroid {
namespace {

TEST(CellGrid, FindsWhatABruteForceSearchFinds) {
  std::vector<Rectangle> rectangles;
  rectangles.reserve(300);
  for (int i = 0; i < 300; ++i)
    rectangles.push_back({(i * 37) % 211 - 20, (i * 53) % 173 - 30, i % 7, 1 + (i * 3) % (i % 50 == 0 ? 90 : 11)});
  const detail::CellGrid grid(rectangles);
  std::vector<std::size_t> found;
  for (int k = 0; k < 200; ++k) {
    const Rectangle query{(k * 41) % 260 - 50, (k * 29) % 230 - 50, k % 13, (k * 7) % 40};
    grid.find(query, found);
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < rectangles.size(); ++i)
      if (!intersect(rectangles[i], query).empty()) expected.push_back(i);
    EXPECT_EQ(found, expected) << k;
  }
}

TEST(CellGrid, OfNothingFindsNothing) {
  std::vector<std::size_t> found{1, 2};
  detail::CellGrid({}).find({0, 0, 10, 10}, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace astroid
