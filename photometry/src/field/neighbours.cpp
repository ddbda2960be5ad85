#include "field/neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

Neighbours::Neighbours(std::span<const ModelStar> stars, double reach) : stars_(stars), cell_(std::max(reach, 1.0)) {
  if (stars.empty()) return;
  double x1 = stars[0].x;
  double y1 = stars[0].y;
  x0_ = x1;
  y0_ = y1;
  for (const ModelStar& star : stars) {
    x0_ = std::min(x0_, star.x);
    x1 = std::max(x1, star.x);
    y0_ = std::min(y0_, star.y);
    y1 = std::max(y1, star.y);
  }
  columns_ = static_cast<int>((x1 - x0_) / cell_) + 1;
  rows_ = static_cast<int>((y1 - y0_) / cell_) + 1;
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  std::vector<std::uint32_t> cell(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) {
    cell[i] = static_cast<std::uint32_t>(static_cast<int>((stars[i].y - y0_) / cell_) * columns_ +
                                         static_cast<int>((stars[i].x - x0_) / cell_));
    ++first_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  members_.resize(stars.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < stars.size(); ++i) members_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
}

void Neighbours::find(double x, double y, double distance, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (columns_ == 0) return;
  const auto range = [this](double low, double high, int count, int& first, int& last) {
    first = std::clamp(static_cast<int>(std::floor(low / cell_)), 0, count - 1);
    last = std::clamp(static_cast<int>(std::floor(high / cell_)), 0, count - 1);
  };
  int i0 = 0;
  int i1 = 0;
  int j0 = 0;
  int j1 = 0;
  range(x - distance - x0_, x + distance - x0_, columns_, i0, i1);
  range(y - distance - y0_, y + distance - y0_, rows_, j0, j1);
  for (int j = j0; j <= j1; ++j) {
    const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_);
    for (std::uint32_t k = first_[row + static_cast<std::size_t>(i0)];
         k < first_[row + static_cast<std::size_t>(i1) + 1]; ++k) {
      const ModelStar& star = stars_[members_[k]];
      const double dx = star.x - x;
      const double dy = star.y - y;
      if (dx * dx + dy * dy <= distance * distance) found.push_back(members_[k]);
    }
  }
  std::sort(found.begin(), found.end());
}

}  // namespace astroid::detail
