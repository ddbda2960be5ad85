#include "astroid/core/throughput.hpp"

#include <algorithm>
#include <cstddef>

#include "astroid/core/math.hpp"
#include "astroid/core/run_time.hpp"

namespace astroid {

namespace {

constexpr double kSecondsPerYear = 365.25 * 86400.0;

}  // namespace

double throughput_at(const Mission& mission, Seconds time) {
  const ThroughputSettings& t = mission.telescope.throughput;
  const double age = t.age_years + (quarter_start(mission) + time).value() / kSecondsPerYear;
  return std::max(0.0, t.beginning_of_life * (1.0 - (1.0 - t.end_of_life) * age / t.lifetime_years));
}

double mean_throughput(const Mission& mission) {
  return throughput_at(mission, middle_of_run(mission.simulation));  // it is linear in time
}

double vignetting_at(const VignettingSettings& settings, Degrees angle) {
  switch (settings.model) {
    case VignettingModel::kNone:
      return 1.0;
    case VignettingModel::kCosineSquared: {
      const double cosine = det::cos(to_radians(angle).value());
      return cosine * cosine;
    }
    case VignettingModel::kPolynomial: {
      constexpr double kPercent = 0.01;
      const double x2 = angle.value() * angle.value();
      double loss = 0.0;
      for (std::size_t i = settings.polynomial.size(); i-- > 0;) loss = (loss + settings.polynomial[i]) * x2;
      return std::clamp(1.0 - kPercent * loss, 0.0, 1.0);
    }
  }
  return 1.0;
}

double vignetting_at(const VignettingSettings& settings, const SkyProjection& projection, PixelPosition position) {
  if (settings.model == VignettingModel::kNone) return 1.0;
  const auto angle = projection.field_angle(position);
  return angle ? vignetting_at(settings, *angle) : 0.0;
}

}  // namespace astroid
