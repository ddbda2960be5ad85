#include "group/friends.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace astroid::detail {

namespace {

using Group = std::vector<std::size_t>;

std::vector<Group> link(std::span<const PixelPosition> places, Group members, double distance) {
  // Along x, so that each looks only at those within the distance.
  std::ranges::stable_sort(members, [&](std::size_t a, std::size_t b) { return places[a].x < places[b].x; });
  std::vector<std::size_t> parent(members.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = i + 1; j < members.size(); ++j) {
      const PixelPosition& a = places[members[i]];
      const PixelPosition& b = places[members[j]];
      if (b.x - a.x > distance) break;
      if (std::hypot(b.x - a.x, b.y - a.y) <= distance) parent[root(j)] = root(i);
    }
  std::vector<Group> groups(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) groups[root(i)].push_back(members[i]);
  std::erase_if(groups, [](const Group& g) { return g.empty(); });
  for (Group& g : groups) std::ranges::sort(g);
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> friends_of_friends(std::span<const PixelPosition> places, double distance,
                                                         std::size_t most) {
  constexpr double kShorter = 0.8;
  constexpr double kShortest = 1e-3;
  Group all;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::isfinite(places[i].x) && std::isfinite(places[i].y)) all.push_back(i);
  std::vector<Group> done;
  std::vector<Group> todo = link(places, std::move(all), distance);
  for (double d = distance * kShorter; !todo.empty(); d *= kShorter) {
    std::vector<Group> large;
    for (Group& group : todo) {
      if (group.size() <= most) {
        done.push_back(std::move(group));
      } else if (d < kShortest * distance) {
        for (std::size_t i = 0; i < group.size(); i += most)
          done.emplace_back(group.begin() + static_cast<std::ptrdiff_t>(i),
                            group.begin() + static_cast<std::ptrdiff_t>(std::min(i + most, group.size())));
      } else {
        for (Group& part : link(places, std::move(group), d)) large.push_back(std::move(part));
      }
    }
    todo = std::move(large);
  }
  std::ranges::sort(done, [](const Group& a, const Group& b) { return a.front() < b.front(); });
  return done;
}

}  // namespace astroid::detail
