#include "source_places.hpp"

#include <cmath>
#include <utility>

#include "astroid/core/error.hpp"
#include "astroid/photometry/estimator.hpp"
#include "counts.hpp"

namespace astroid::detail {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check_positions(std::span<const SourceRequest> sources, const SkyProjection* sky) {
  if (sky != nullptr) return;
  for (const SourceRequest& source : sources) {
    if (source.pixel || !source.sky) continue;
    Problem problem;
    problem.parameter = "source " + source.id;
    problem.expected = "x and y, or an image with celestial coordinates";
    problem.message = "a position in the sky, but the image has no coordinates";
    throw InputError(std::move(problem));
  }
}

PixelPosition position_of(const SourceRequest& source, const SkyProjection* sky) {
  if (source.pixel) return *source.pixel;
  if (source.sky && sky != nullptr) return sky->to_pixel(*source.sky).value_or(PixelPosition{kNaN, kNaN});
  return {kNaN, kNaN};
}

}  // namespace

bool on_frame(PixelPosition p, const Rectangle& area) {
  return p.x >= area.x0 - 0.5 && p.x < area.x1() - 0.5 && p.y >= area.y0 - 0.5 && p.y < area.y1() - 0.5;
}

std::vector<SourceMeasurement> rows_of(std::span<const SourceRequest> sources, const SkyProjection* sky) {
  check_positions(sources, sky);
  std::vector<SourceMeasurement> measured(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    SourceMeasurement& m = measured[i];
    const PixelPosition centre = position_of(sources[i], sky);
    SkyPosition direction{kNaN, kNaN};
    if (sources[i].sky) {
      direction = *sources[i].sky;
    } else if (sky != nullptr && std::isfinite(centre.x) && std::isfinite(centre.y)) {
      direction = sky->to_sky(centre);
    }
    m.id = sources[i].id;
    m.x = centre.x;
    m.y = centre.y;
    m.ra = direction.ra;
    m.dec = direction.dec;
    m.flux = m.flux_err = m.mag = m.mag_err = m.background = m.snr = m.chi2 = kNaN;
  }
  return measured;
}

std::uint32_t pixel_flags_around(const Frame& frame, PixelPosition place, int half) {
  const auto flags = frame.flags.view(0);
  const auto values = frame.pixels.view(0);
  const Rectangle& area = flags.area();
  const int x0 = static_cast<int>(std::floor(place.x + 0.5));
  const int y0 = static_cast<int>(std::floor(place.y + 0.5));
  std::uint32_t result = 0;
  for (int y = y0 - half; y <= y0 + half; ++y) {
    for (int x = x0 - half; x <= x0 + half; ++x) {
      if (!area.contains(x, y)) {
        result |= measurement_flag::kEdge;
        continue;
      }
      const unsigned f = flags.at(x, y);
      if ((f & (pixel_flag::kFullWell | pixel_flag::kAdcSaturated)) != 0U) result |= measurement_flag::kSaturated;
      if ((f & pixel_flag::kBad) != 0U || !is_count(values.at(x, y))) result |= measurement_flag::kBadPixel;
    }
  }
  return result;
}

bool may_be_fitted(unsigned flags, float value) {
  constexpr unsigned kUnusable = 0xFFU & ~(pixel_flag::kTruth | pixel_flag::kShortRamp);
  return is_count(value) && (flags & kUnusable) == 0U;
}

}  // namespace astroid::detail
