#include "reference_pixels.hpp"

#include <algorithm>

#include "astroid/core/readout_nodes.hpp"

namespace astroid {

namespace {

struct Interval {
  int begin, end;
};

/// Sorted, and joined where they touch.
std::vector<Interval> joined(std::vector<Interval> intervals) {
  std::ranges::sort(intervals, {}, &Interval::begin);
  std::vector<Interval> result;
  for (const Interval& i : intervals) {
    if (!result.empty() && i.begin <= result.back().end)
      result.back().end = std::max(result.back().end, i.end);
    else
      result.push_back(i);
  }
  return result;
}

}  // namespace

std::vector<Rectangle> reference_regions(std::span<const Rectangle> exposed, const Rectangle& detector,
                                         const ReferencePixels& reference, int nodes) {
  std::vector<Interval> columns;
  std::vector<Interval> rows;
  for (const Rectangle& r : exposed) {
    columns.push_back({r.x0, r.x1()});
    rows.push_back({r.y0, r.y1()});
  }
  std::vector<Rectangle> regions;
  const auto add = [&regions](const Rectangle& r) {
    if (!r.empty()) regions.push_back(r);
  };
  for (const Interval& r : joined(std::move(rows))) {
    add({detector.x0 - reference.prescan, r.begin, reference.prescan, r.end - r.begin});
    add({detector.x1(), r.begin, reference.serial_overscan, r.end - r.begin});
  }
  const bool splits = ReadoutNodes(detector, nodes).splits_columns();
  for (const Interval& c : joined(std::move(columns))) {
    add({c.begin, detector.y1(), c.end - c.begin, reference.parallel_overscan});
    if (splits) add({c.begin, detector.y0 - reference.parallel_overscan, c.end - c.begin, reference.parallel_overscan});
  }
  return regions;
}

}  // namespace astroid
