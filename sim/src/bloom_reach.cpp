#include "bloom_reach.hpp"

#include <algorithm>
#include <cmath>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr double kSpare = 1.1;
constexpr double kSigmas = 10.0;
constexpr int kColumnsAtOnce = 16;

double at_most(double electrons) {
  return electrons + kSigmas * det::sqrt(electrons);
}

}  // namespace

BloomReach::BloomReach(const Scene& scene) : detector_(scene.detector()) {
  constexpr double kOutside = 1e-4;  // of a star's light: within the 10 %
  const SceneSummary& summary = scene.summary();
  const ChargeInjectionSettings& injection = scene.mission().ccd.charge_injection;
  const double injected = injection.every_rows > 0 ? injection.level.value() : 0.0;
  // The sky differs over the field and the year.
  constexpr double kBackgroundSpare = 2.0;
  room_ = scene.mission().ccd.full_well.value() - at_most(kBackgroundSpare * summary.background + injected);
  width_ = scene.psf().stamp_half_width(kOutside) + kSigmas * summary.attitude_rms_px + summary.drift_px +
           summary.repointing_px + summary.aberration_px + 1.0;
  for (const SceneStar& star : scene.stars()) {
    const double electrons = star.electrons + (star.variability >= 0 ? summary.largest_variation : 0.0);
    if (electrons > 0.0) sources_.push_back({star.position.x, star.position.y, kSpare * at_most(electrons)});
  }
  std::ranges::sort(sources_, {}, &Source::y);
}

Rectangle BloomReach::support(const Rectangle& region) const {
  Rectangle all = region;
  for (int x = region.x0; x < region.x1(); x += kColumnsAtOnce) {
    const Rectangle some = support_of_columns({x, region.y0, std::min(kColumnsAtOnce, region.x1() - x), region.ny});
    const int y0 = std::min(all.y0, some.y0);
    all.ny = std::max(all.y1(), some.y1()) - y0;
    all.y0 = y0;
  }
  return all;
}

Rectangle BloomReach::support_of_columns(const Rectangle& region) const {
  if (room_ <= 0.0) return {region.x0, detector_.y0, region.nx, detector_.ny};
  std::vector<Source> near;
  std::ranges::copy_if(sources_, std::back_inserter(near),
                       [&](const Source& s) { return s.x >= region.x0 - width_ && s.x <= region.x1() - 1 + width_; });
  double first = region.y0;
  double last = region.y1() - 1;
  for (std::size_t i = 0; i < near.size(); ++i) {
    double electrons = 0.0;
    for (std::size_t j = i; j < near.size(); ++j) {
      // A run of full pixels that all of i ... j may have filled, ending at the region or beyond it.
      electrons += near[j].electrons;
      const double length = electrons / room_;
      const double begin = std::max(region.y0 - 1.0, near[j].y - width_) + 1.0 - length;
      if (begin <= near[i].y + width_) first = std::min(first, begin);
      const double end = std::min(static_cast<double>(region.y1()), near[i].y + width_) - 1.0 + length;
      if (end >= near[j].y - width_) last = std::max(last, end);
    }
  }
  const int y0 = std::max(detector_.y0, static_cast<int>(std::floor(std::max(first, -1e9))));
  const int y1 = std::min(detector_.y1(), static_cast<int>(std::ceil(std::min(last, 1e9))) + 1);
  return {region.x0, y0, region.nx, y1 - y0};
}

}  // namespace astroid
