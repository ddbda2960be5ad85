#include "plane_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "astroid/core/math.hpp"

namespace astroid::detail {

namespace {

// How the safe radius is found: the determinant on circles 64 px apart, well above 0 everywhere.
constexpr double kCircleStep = 64.0;  // px
constexpr int kCircles = 512;         // up to 32768 px from the axis, beyond any detector
constexpr int kAzimuths = 64;
constexpr double kSafeDeterminant = 0.1;

constexpr double kRayRatio = 0.98;      // of places on a line at which a fold is looked for
constexpr double kNearest = 1e-6;       // px; nearer than this to the axis nothing folds
constexpr int kContinuationSteps = 32;  // from the axis, where Newton's method does not get there at once
constexpr int kIterations = 60;         // quadratic convergence takes five; the rest is for starts near a fold
constexpr int kHalvings = 30;
constexpr double kTwoPi = 6.283185307179586476925286766559;

double length(PixelShift s) {
  return det::hypot(s.dx, s.dy);
}

PixelShift scaled(double factor, PixelShift s) {
  return {factor * s.dx, factor * s.dy};
}

}  // namespace

PlaneMap::PlaneMap(Evaluate evaluate) : evaluate_(std::move(evaluate)) {
  for (int circle = 1; circle <= kCircles; ++circle) {
    const double radius = kCircleStep * circle;
    for (int k = 0; k < kAzimuths; ++k) {
      const double angle = kTwoPi * k / kAzimuths;
      // The negated comparison also ends the search where the map overflows.
      if (!(evaluate_({radius * det::cos(angle), radius * det::sin(angle)}).determinant() > kSafeDeterminant)) return;
    }
    safe_radius_ = radius - kCircleStep;
  }
}

bool PlaneMap::is_unfolded(PixelShift place) const {
  const double radius = length(place);
  const double nearest = std::max(safe_radius_, kNearest);
  for (double fraction = 1.0; fraction * radius > nearest; fraction *= kRayRatio) {
    if (!evaluate_(scaled(fraction, place)).is_upright()) return false;
  }
  return true;
}

std::optional<PixelShift> PlaneMap::value(PixelShift place) const {
  if (!std::isfinite(place.dx) || !std::isfinite(place.dy) || !is_unfolded(place)) return std::nullopt;
  const PixelShift value = evaluate_(place).value;
  if (!std::isfinite(value.dx) || !std::isfinite(value.dy)) return std::nullopt;
  return value;
}

std::optional<PixelShift> PlaneMap::newton(PixelShift target, PixelShift start) const {
  // Rounding of the polynomial: some units in the last place of the offset.
  const double tolerance = 8.0 * std::numeric_limits<double>::epsilon() * (1.0 + length(target));
  constexpr double kWorstResidual = 1e-10;  // px; what stagnation by rounding may leave
  PixelShift place = start;
  MapPoint at = evaluate_(place);
  PixelShift residual{at.value.dx - target.dx, at.value.dy - target.dy};
  double norm = length(residual);
  for (int i = 0; i < kIterations && norm > tolerance; ++i) {
    const double determinant = at.determinant();
    const PixelShift step{(at.yy * residual.dx - at.xy * residual.dy) / determinant,
                          (at.xx * residual.dy - at.yx * residual.dx) / determinant};
    bool better = false;
    double part = 1.0;
    for (int k = 0; k < kHalvings && !better; ++k, part *= 0.5) {
      const PixelShift trial{place.dx - part * step.dx, place.dy - part * step.dy};
      const MapPoint there = evaluate_(trial);
      const PixelShift left{there.value.dx - target.dx, there.value.dy - target.dy};
      if (!there.is_upright() || !(length(left) < norm)) continue;
      place = trial;
      at = there;
      residual = left;
      norm = length(left);
      better = true;
    }
    if (!better) break;
  }
  if (!(norm <= std::max(tolerance, kWorstResidual)) || !is_unfolded(place)) return std::nullopt;
  return place;
}

std::optional<PixelShift> PlaneMap::solve(PixelShift target) const {
  if (!std::isfinite(target.dx) || !std::isfinite(target.dy)) return std::nullopt;
  // The map is near the identity, so its fixed-point iteration begins at the target; where that is folded, nearer.
  PixelShift start = target;
  for (int k = 0; k < kHalvings && !is_unfolded(start); ++k) start = scaled(0.5, start);
  if (const auto place = newton(target, start)) return place;
  PixelShift place{};
  for (int k = 1; k <= kContinuationSteps; ++k) {
    const auto next = newton(scaled(static_cast<double>(k) / kContinuationSteps, target), place);
    if (!next) return std::nullopt;
    place = *next;
  }
  return place;
}

}  // namespace astroid::detail
