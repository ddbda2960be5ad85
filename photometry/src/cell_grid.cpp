#include "cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace astroid::detail {

namespace {

// Cells about as large as the rectangles keep both a rectangle's cells and a cell's rectangles few.
constexpr int kSmallestCell = 8;
constexpr double kCellsPerRectangle = 4.0;  // bounds the memory of a few rectangles spread over a large detector

}  // namespace

CellGrid::CellGrid(std::span<const Rectangle> rectangles) : rectangles_(rectangles) {
  int x0 = std::numeric_limits<int>::max();
  int y0 = x0;
  int x1 = std::numeric_limits<int>::min();
  int y1 = x1;
  double side_sum = 0.0;
  std::size_t count = 0;
  for (const Rectangle& r : rectangles) {
    if (r.empty()) continue;
    x0 = std::min(x0, r.x0);
    y0 = std::min(y0, r.y0);
    x1 = std::max(x1, r.x1());
    y1 = std::max(y1, r.y1());
    side_sum += std::max(r.nx, r.ny);
    ++count;
  }
  if (count == 0) return;
  bounds_ = {x0, y0, x1 - x0, y1 - y0};
  const double number = static_cast<double>(count);
  const double from_size = side_sum / number;
  const double from_count = std::sqrt(static_cast<double>(bounds_.size()) / (kCellsPerRectangle * number));
  cell_ = std::max(kSmallestCell, static_cast<int>(std::max(from_size, from_count)));
  columns_ = (bounds_.nx - 1) / cell_ + 1;
  rows_ = (bounds_.ny - 1) / cell_ + 1;

  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  first_.assign(cells + 1, 0);
  const auto for_each_cell = [this](const Rectangle& r, auto&& visit) {
    const CellRange range = cells_of(r);
    for (int row = range.y0; row <= range.y1; ++row)
      for (int column = range.x0; column <= range.x1; ++column)
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column));
  };
  for (const Rectangle& r : rectangles)
    if (!r.empty()) for_each_cell(r, [this](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell < cells; ++cell) first_[cell + 1] += first_[cell];
  members_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < rectangles.size(); ++i)
    if (!rectangles[i].empty()) for_each_cell(rectangles[i], [&](std::size_t cell) { members_[next[cell]++] = i; });
}

CellGrid::CellRange CellGrid::cells_of(const Rectangle& rectangle) const {
  return {(rectangle.x0 - bounds_.x0) / cell_, (rectangle.x1() - 1 - bounds_.x0) / cell_,
          (rectangle.y0 - bounds_.y0) / cell_, (rectangle.y1() - 1 - bounds_.y0) / cell_};
}

void CellGrid::find(const Rectangle& query, std::vector<std::size_t>& found) const {
  found.clear();
  const Rectangle inside = intersect(query, bounds_);
  if (inside.empty()) return;
  const CellRange range = cells_of(inside);
  for (int row = range.y0; row <= range.y1; ++row) {
    for (int column = range.x0; column <= range.x1; ++column) {
      const std::size_t cell =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
      for (std::size_t k = first_[cell]; k < first_[cell + 1]; ++k)
        if (!intersect(rectangles_[members_[k]], query).empty()) found.push_back(members_[k]);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace astroid::detail
