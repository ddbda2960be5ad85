#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "catalogue_checks.hpp"

namespace astroid {

namespace {

constexpr double kPositionSteps = 1e7;  // per deg or px: finer than any catalogue, coarser than its rounding

/// FNV-1a over the sixteen bytes of two integers, lowest byte first: fixed for ever, since ids address random draws.
std::uint64_t hash_position(std::int64_t first, std::int64_t second) {
  std::string bytes;
  for (const auto value : {static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(second)}) {
    for (unsigned shift = 0; shift < 64U; shift += 8U) bytes += static_cast<char>((value >> shift) & 0xFFU);
  }
  return star_hash(bytes);
}

std::string position_id(const CatalogueStar& star, PositionKind kind) {
  const double first = kind == PositionKind::kSky ? star.sky.ra : star.pixel.x;
  const double second = kind == PositionKind::kSky ? star.sky.dec : star.pixel.y;
  return fmt::format("h{:016x}",
                     hash_position(std::llround(first * kPositionSteps), std::llround(second * kPositionSteps)));
}

/// Positions that are wrong, and reported as such, have no hash.
bool has_position(const CatalogueStar& star, PositionKind kind) {
  constexpr double kFarthest = 1e6;  // deg or px
  const double first = kind == PositionKind::kSky ? star.sky.ra : star.pixel.x;
  const double second = kind == PositionKind::kSky ? star.sky.dec : star.pixel.y;
  return std::abs(first) <= kFarthest && std::abs(second) <= kFarthest;
}

bool same_brightness(const CatalogueStar& a, const CatalogueStar& b) {
  return a.magnitude == b.magnitude && a.electrons == b.electrons;
}

}  // namespace

void name_stars(const CatalogueTable& table, const CatalogueColumns& columns, std::span<const std::size_t> rows,
                StarCatalogue& catalogue, ProblemList& problems) {
  std::unordered_map<std::string, std::size_t> first_with_id;
  std::unordered_map<std::string, std::vector<std::size_t>> stars_at;
  first_with_id.reserve(catalogue.stars.size());
  std::size_t unnamed = 0;
  std::size_t sharing = 0;
  for (std::size_t i = 0; i < catalogue.stars.size(); ++i) {
    CatalogueStar& star = catalogue.stars[i];
    if (star.id.empty()) {
      if (!has_position(star, catalogue.positions)) continue;
      ++unnamed;
      const std::string id = position_id(star, catalogue.positions);
      std::vector<std::size_t>& here = stars_at[id];
      for (const std::size_t other : here) {
        if (!same_brightness(star, catalogue.stars[other])) continue;
        problems.add(table.problem(
            rows[i], *columns.first,
            fmt::format("the same star as in {}: same position, same brightness", table.where(rows[other])),
            "each star once, or a column id"));
        break;
      }
      here.push_back(i);
      sharing += here.size() > 1 ? 1U : 0U;
      star.id = here.size() > 1 ? fmt::format("{}-{}", id, here.size()) : id;
    }
    const auto [other, is_new] = first_with_id.emplace(star.id, i);
    if (!is_new && columns.id) {
      problems.add(table.problem(rows[i], *columns.id,
                                 fmt::format("the same id as in {}", table.where(rows[other->second])),
                                 "ids that are there once"));
    }
  }
  if (unnamed > 0) {
    catalogue.notes.push_back(
        fmt::format("{} of {} stars have no id: named by a hash of their position", unnamed, catalogue.stars.size()));
  }
  if (sharing > 0) catalogue.notes.push_back(fmt::format("{} stars share the position of another", sharing));
}

}  // namespace astroid
