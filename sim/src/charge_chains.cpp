#include "charge_chains.hpp"

#include <algorithm>

namespace astroid {

namespace {

/// Columns first ... last that the same region follows, if any does.
struct Stretch {
  int begin;
  int end;
  const ChargeRegion* follower;
};

/// Cuts begin ... end where `follower_at` changes.
template <class FollowerAt>
std::vector<Stretch> stretches(int begin, int end, const FollowerAt& follower_at) {
  std::vector<Stretch> result;
  for (int i = begin; i < end; ++i) {
    const ChargeRegion* follower = follower_at(i);
    if (!result.empty() && result.back().follower == follower)
      result.back().end = i + 1;
    else
      result.push_back({i, i + 1, follower});
  }
  return result;
}

/// The reference region that holds a pixel, or none.
const ChargeRegion* reference_at(const ChargePixels& pixels, int x, int y) {
  for (std::size_t r = pixels.exposed; r < pixels.regions.size(); ++r)
    if (pixels.regions[r].area.contains(x, y)) return &pixels.regions[r];
  return nullptr;
}

/// The overscan rows that column x of a region trails into.
const ChargeRegion* rows_behind(const ChargePixels& pixels, std::size_t region, int x) {
  for (const TrailSource& source : pixels.into_rows)
    if (x >= source.valid.x0 && x < source.valid.x1())
      return source.region == region ? reference_at(pixels, x, pixels.detector.y1()) : nullptr;
  return nullptr;
}

/// The overscan columns that row y of a region trails into.
const ChargeRegion* columns_behind(const ChargePixels& pixels, std::size_t region, int y) {
  for (const TrailSource& source : pixels.into_columns)
    if (y >= source.valid.y0 && y < source.valid.y1())
      return source.region == region ? reference_at(pixels, pixels.detector.x1(), y) : nullptr;
  return nullptr;
}

/// Some rows of a region with what follows each, turned so that columns are packets.
class TurnedRows {
 public:
  TurnedRows(const ChargeRegion& region, const ChargeRegion* follower, int y0, int y1)
      : region_(region), follower_(follower), y0_(y0), height_(static_cast<std::size_t>(y1 - y0)) {}

  /// Columns x0 ... x1-1, then those of the follower if they are read in rising order.
  double move(int x0, int x1, bool rising, int first_transfers, const MoveChain& move) {
    const int behind = rising && follower_ != nullptr ? follower_->area.nx : 0;
    const auto own = static_cast<std::size_t>(x1 - x0);
    const std::size_t columns = own + static_cast<std::size_t>(behind);
    turned_.resize(columns * height_);
    const auto for_each = [&](auto&& visit) {
      for (std::size_t j = 0; j < height_; ++j) {
        const int y = y0_ + static_cast<int>(j);
        double* const row = region_.at(x0, y);
        for (std::size_t i = 0; i < own; ++i) visit(row[i], turned_[i * height_ + j]);
        if (behind == 0) continue;
        double* const overscan = follower_->at(follower_->area.x0, y);
        for (std::size_t i = 0; i < static_cast<std::size_t>(behind); ++i)
          visit(overscan[i], turned_[(own + i) * height_ + j]);
      }
    };
    for_each([](double pixel, double& turned) { turned = pixel; });
    TransferChain chain{{}, height_, first_transfers};
    for (std::size_t i = 0; i < columns; ++i) chain.packets.push_back(turned_.data() + i * height_);
    if (!rising) std::ranges::reverse(chain.packets);
    const double lost = move(chain);
    for_each([](double& pixel, double turned) { pixel = turned; });
    return lost;
  }

 private:
  const ChargeRegion& region_;
  const ChargeRegion* follower_;
  int y0_;
  std::size_t height_;
  std::vector<double> turned_;
};

}  // namespace

double move_rows(const ChargePixels& pixels, const MoveChain& move) {
  double lost = 0.0;
  for (std::size_t r = 0; r < pixels.exposed; ++r) {
    const ChargeRegion& region = pixels.regions[r];
    const Rectangle& area = region.area;
    for (const Stretch& columns : stretches(area.x0, area.x1(), [&](int x) { return rows_behind(pixels, r, x); })) {
      TransferChain chain{{}, static_cast<std::size_t>(columns.end - columns.begin), area.y0 - pixels.detector.y0 + 1};
      for (int y = area.y0; y < area.y1(); ++y) chain.packets.push_back(region.at(columns.begin, y));
      if (columns.follower != nullptr)
        for (int y = columns.follower->area.y0; y < columns.follower->area.y1(); ++y)
          chain.packets.push_back(columns.follower->at(columns.begin, y));
      lost += move(chain);
    }
  }
  return lost;
}

double move_columns(const ChargePixels& pixels, int middle, int before, const MoveChain& move) {
  constexpr int kRowsAtOnce = 64;
  const Rectangle& detector = pixels.detector;
  double lost = 0.0;
  for (std::size_t r = 0; r < pixels.regions.size(); ++r) {
    const Rectangle& area = pixels.regions[r].area;
    if (area.x0 < detector.x0 || area.x1() > detector.x1()) continue;  // overscan columns move with the others
    const int split = std::clamp(middle, area.x0, area.x1());
    for (const Stretch& rows : stretches(area.y0, area.y1(), [&](int y) { return columns_behind(pixels, r, y); })) {
      for (int y = rows.begin; y < rows.end; y += kRowsAtOnce) {
        TurnedRows turned(pixels.regions[r], rows.follower, y, std::min(rows.end, y + kRowsAtOnce));
        if (area.x0 < split) lost += turned.move(area.x0, split, true, area.x0 - detector.x0 + 1 + before, move);
        if (split < area.x1())
          lost += turned.move(split, area.x1(), false, detector.x1() - area.x1() + 1 + before, move);
      }
    }
  }
  return lost;
}

}  // namespace astroid
