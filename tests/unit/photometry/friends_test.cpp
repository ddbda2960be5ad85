#include "group/friends.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace astroid::detail {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

TEST(FriendsOfFriends, AreChainsOfNeighbours) {
  const std::vector<PixelPosition> places{{0, 0}, {10, 0}, {1.5, 0}, {3, 0}, {10, 1.9}, {50, 50}};
  EXPECT_EQ(friends_of_friends(places, 2.0, 10), (Groups{{0, 2, 3}, {1, 4}, {5}}));
}

TEST(FriendsOfFriends, OfNoPlaceAreInNoGroup) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(friends_of_friends(std::vector<PixelPosition>{{nan, 0}, {1, 1}}, 2.0, 10), (Groups{{1}}));
  EXPECT_TRUE(friends_of_friends(std::vector<PixelPosition>{}, 2.0, 10).empty());
}

TEST(FriendsOfFriends, FallApartWhereTheyAreTooMany) {
  // A chain of pairs: 1 px within a pair, 1.9 px to the next.
  std::vector<PixelPosition> places;
  for (int i = 0; i < 20; ++i) places.push_back({2.9 * (i / 2) + i % 2, 0.0});
  const Groups groups = friends_of_friends(places, 2.0, 4);
  EXPECT_EQ(groups.size(), 10U);
  for (const auto& group : groups) EXPECT_EQ(group.size(), 2U);
}

TEST(FriendsOfFriends, AreCutWhereAllAreAtOnePlace) {
  const std::vector<PixelPosition> places(25, PixelPosition{3.0, 4.0});
  const Groups groups = friends_of_friends(places, 2.0, 10);
  std::set<std::size_t> seen;
  for (const auto& group : groups) {
    EXPECT_LE(group.size(), 10U);
    seen.insert(group.begin(), group.end());
  }
  EXPECT_EQ(seen.size(), 25U);
}

}  // namespace
}  // namespace astroid::detail
