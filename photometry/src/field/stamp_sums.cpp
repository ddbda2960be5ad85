#include "field/stamp_sums.hpp"

#include <algorithm>

#include "field/place.hpp"

namespace astroid::detail {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
// Four lanes on every processor, so that sums have one order.
using Four = hn::FixedTag<float, 4>;
using Vector = hn::Vec<Four>;

double total(Vector v) {
  alignas(16) std::array<float, 4> lane;
  hn::Store(v, Four(), lane.data());
  return (static_cast<double>(lane[0]) + static_cast<double>(lane[1])) +
         (static_cast<double>(lane[2]) + static_cast<double>(lane[3]));
}

}  // namespace

StampSums weigh_stamp(const StampView& stamp, const PaddedPlane& weight, const PaddedPlane& residual,
                      const WeightedStamp& out) {
  const Four d;
  const Vector zero = hn::Zero(d);
  std::array<Vector, 12> sum;
  sum.fill(zero);
  const auto stride = static_cast<std::size_t>(stamp.stride);
  const auto side = static_cast<std::size_t>(stamp.side);
  for (std::size_t j = 0; j < side; ++j) {
    const float* w = weight.at(stamp.x0, stamp.y0 + static_cast<int>(j));
    const float* r = residual.at(stamp.x0, stamp.y0 + static_cast<int>(j));
    const std::size_t row = j * stride;
    for (std::size_t i = 0; i < side; i += 4) {
      const Vector wv = hn::LoadU(d, w + i);
      const Vector rv = hn::LoadU(d, r + i);
      const Vector p = hn::LoadU(d, stamp.p + row + i);
      const Vector px = hn::LoadU(d, stamp.px + row + i);
      const Vector py = hn::LoadU(d, stamp.py + row + i);
      const Vector wp = hn::Mul(wv, p);
      const Vector wpx = hn::Mul(wv, px);
      const Vector wpy = hn::Mul(wv, py);
      hn::StoreU(wp, d, out.p + row + i);
      hn::StoreU(wpx, d, out.px + row + i);
      hn::StoreU(wpy, d, out.py + row + i);
      sum[0] = hn::Add(sum[0], hn::Mul(wp, p));
      sum[1] = hn::Add(sum[1], hn::Mul(wp, px));
      sum[2] = hn::Add(sum[2], hn::Mul(wp, py));
      sum[3] = hn::Add(sum[3], hn::Mul(wpx, px));
      sum[4] = hn::Add(sum[4], hn::Mul(wpx, py));
      sum[5] = hn::Add(sum[5], hn::Mul(wpy, py));
      sum[6] = hn::Add(sum[6], hn::Mul(wp, rv));
      sum[7] = hn::Add(sum[7], hn::Mul(wpx, rv));
      sum[8] = hn::Add(sum[8], hn::Mul(wpy, rv));
      sum[9] = hn::Add(sum[9], wp);
      sum[10] = hn::Add(sum[10], wpx);
      sum[11] = hn::Add(sum[11], wpy);
    }
    for (std::size_t i = (side + 3) & ~std::size_t{3}; i < stride; i += 4) {
      hn::StoreU(zero, d, out.p + row + i);
      hn::StoreU(zero, d, out.px + row + i);
      hn::StoreU(zero, d, out.py + row + i);
    }
  }
  StampSums s;
  s.pp = total(sum[0]);
  s.ppx = total(sum[1]);
  s.ppy = total(sum[2]);
  s.pxpx = total(sum[3]);
  s.pxpy = total(sum[4]);
  s.pypy = total(sum[5]);
  s.rp = total(sum[6]);
  s.rpx = total(sum[7]);
  s.rpy = total(sum[8]);
  s.p = total(sum[9]);
  s.px = total(sum[10]);
  s.py = total(sum[11]);
  return s;
}

std::array<double, 9> pair_sums(const StampView& first, const WeightedStamp& weighted, const StampView& second) {
  const Four d;
  std::array<Vector, 9> sum;
  sum.fill(hn::Zero(d));
  const int x0 = std::max(first.x0, second.x0);
  const int x1 = std::min(first.x0 + first.side, second.x0 + second.side);
  const int y0 = std::max(first.y0, second.y0);
  const int y1 = std::min(first.y0 + first.side, second.y0 + second.side);
  for (int y = y0; y < y1; ++y) {
    const auto a = place_in(x0 - first.x0, y - first.y0, first.stride);
    const auto b = place_in(x0 - second.x0, y - second.y0, second.stride);
    // What lies beyond the common columns is zero in one of the two: rows of both end in zeros.
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(0, x1 - x0)); i += 4) {
      const Vector wp = hn::LoadU(d, weighted.p + a + i);
      const Vector wpx = hn::LoadU(d, weighted.px + a + i);
      const Vector wpy = hn::LoadU(d, weighted.py + a + i);
      const Vector p = hn::LoadU(d, second.p + b + i);
      const Vector px = hn::LoadU(d, second.px + b + i);
      const Vector py = hn::LoadU(d, second.py + b + i);
      sum[0] = hn::Add(sum[0], hn::Mul(wp, p));
      sum[1] = hn::Add(sum[1], hn::Mul(wp, px));
      sum[2] = hn::Add(sum[2], hn::Mul(wp, py));
      sum[3] = hn::Add(sum[3], hn::Mul(wpx, p));
      sum[4] = hn::Add(sum[4], hn::Mul(wpx, px));
      sum[5] = hn::Add(sum[5], hn::Mul(wpx, py));
      sum[6] = hn::Add(sum[6], hn::Mul(wpy, p));
      sum[7] = hn::Add(sum[7], hn::Mul(wpy, px));
      sum[8] = hn::Add(sum[8], hn::Mul(wpy, py));
    }
  }
  std::array<double, 9> result;
  for (std::size_t k = 0; k < 9; ++k) result[k] = total(sum[k]);
  return result;
}

void add_stamp(const StampView& stamp, float flux, PaddedPlane& plane) {
  const Four d;
  const Vector f = hn::Set(d, flux);
  for (int j = 0; j < stamp.side; ++j) {
    float* to = plane.at(stamp.x0, stamp.y0 + j);
    const float* p = stamp.p + static_cast<std::size_t>(j) * static_cast<std::size_t>(stamp.stride);
    for (int i = 0; i < stamp.side; i += 4)
      hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::Mul(f, hn::LoadU(d, p + i))), d, to + i);
  }
}

}  // namespace astroid::detail
