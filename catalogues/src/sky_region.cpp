#include "astroid/catalogues/sky_region.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/sphere.hpp"

namespace astroid {

namespace {

constexpr double kDegreesPerRadian = 180.0 / kPi;
constexpr double kRoundingSlack = 1e-9;  // deg: points on the edge belong to the region, however they were rounded

/// East, north and outward unit vectors at a place of the sky.
struct Frame {
  Direction outward;
  Direction east;
  Direction north;
};

Frame frame_at(SkyPosition centre) {
  const auto [east, north] = horizon(centre);
  return {.outward = to_direction(centre), .east = east, .north = north};
}

/// Components towards the outward, east and north vectors of `frame` as a direction of the sky.
Direction in_sky(const Frame& frame, const Direction& local) {
  return {local.x * frame.outward.x + local.y * frame.east.x + local.z * frame.north.x,
          local.x * frame.outward.y + local.y * frame.east.y + local.z * frame.north.y,
          local.x * frame.outward.z + local.y * frame.east.z + local.z * frame.north.z};
}

double half_sine(Degrees angle) {
  return sine_cosine(angle / 2.0).sine;
}

Direction unit_vector(const Direction& v) {
  const double length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

/// The centre of the smallest cap around the directions, to about 1 / kSteps of its radius: steps of falling length
/// towards the farthest direction. @source Badoiu2003 (Badoiu & Clarkson, Smaller core-sets for balls).
Direction smallest_enclosing_centre(std::span<const Direction> directions, const Direction& start) {
  constexpr int kSteps = 300;
  Direction centre = unit_vector(start);
  for (int step = 1; step <= kSteps; ++step) {
    const auto farthest = std::min_element(directions.begin(), directions.end(), [&](const auto& a, const auto& b) {
      return dot(a, centre) < dot(b, centre);
    });
    const double part = 1.0 / (step + 1.0);
    centre = unit_vector({centre.x + part * (farthest->x - centre.x), centre.y + part * (farthest->y - centre.y),
                          centre.z + part * (farthest->z - centre.z)});
  }
  return centre;
}

InputError region_error(const char* parameter, double value, const char* expected) {
  return InputError({.file = {},
                     .line = 0,
                     .parameter = parameter,
                     .value = std::to_string(value),
                     .expected = expected,
                     .message = "the region of the sky is empty or too large",
                     .suggestion = {}});
}

}  // namespace

double square_degrees(const SkyRegion& region) {
  const double steradian = kDegreesPerRadian * kDegreesPerRadian;
  if (region.radius.value() != 0.0) {
    if (!(region.radius.value() > 0.0 && region.radius.value() <= 180.0)) {
      throw region_error("radius", region.radius.value(), "above 0, up to 180 deg");
    }
    const double sine = half_sine(region.radius);
    return 4.0 * kPi * sine * sine * steradian;
  }
  if (!(region.width.value() > 0.0 && region.width.value() <= 360.0)) {
    throw region_error("width", region.width.value(), "above 0, up to 360 deg");
  }
  if (!(region.height.value() > 0.0 && region.height.value() <= 180.0)) {
    throw region_error("height", region.height.value(), "above 0, up to 180 deg");
  }
  return region.width.value() * 2.0 * half_sine(region.height) * kDegreesPerRadian;
}

bool contains(const SkyRegion& region, SkyPosition position) {
  if (region.radius.value() != 0.0) {
    return angular_separation(region.centre, position).value() <= region.radius.value() + kRoundingSlack;
  }
  const Frame frame = frame_at(region.centre);
  const Direction direction = to_direction(position);
  const double longitude = det::atan2(dot(direction, frame.east), dot(direction, frame.outward)) * kDegreesPerRadian;
  const double latitude = det::asin(std::clamp(dot(direction, frame.north), -1.0, 1.0)) * kDegreesPerRadian;
  return std::abs(longitude) <= region.width.value() / 2.0 + kRoundingSlack &&
         std::abs(latitude) <= region.height.value() / 2.0 + kRoundingSlack;
}

SkyPosition point_of(const SkyRegion& region, double u, double v) {
  const Frame frame = frame_at(region.centre);
  if (region.radius.value() != 0.0) {
    // Equal areas: 1 - cos(theta) = 2 sin^2(theta / 2) is uniform.
    const double sine_of_half = std::sqrt(u) * half_sine(region.radius);
    const double cosine_of_half = std::sqrt(1.0 - sine_of_half * sine_of_half);
    const double sine = 2.0 * sine_of_half * cosine_of_half;
    const SineCosine angle = sine_cosine(Degrees(360.0 * v));
    return to_sky_position(
        in_sky(frame, {1.0 - 2.0 * sine_of_half * sine_of_half, sine * angle.sine, sine * angle.cosine}));
  }
  // Equal areas: the sine of the latitude is uniform.
  const double sine = half_sine(region.height) * (2.0 * v - 1.0);
  const double cosine = std::sqrt(1.0 - sine * sine);
  const SineCosine longitude = sine_cosine(region.width * (u - 0.5));
  return to_sky_position(in_sky(frame, {cosine * longitude.cosine, cosine * longitude.sine, sine}));
}

SkyRegion enclosing_cap(const StarCatalogue& catalogue) {
  Direction sum{0.0, 0.0, 0.0};
  for (const CatalogueStar& star : catalogue.stars) {
    const Direction direction = to_direction(star.sky);
    sum = {sum.x + direction.x, sum.y + direction.y, sum.z + direction.z};
  }
  constexpr double kShortestMean = 0.05;  // of a unit vector; below, the direction is chance
  const double length = std::sqrt(dot(sum, sum));
  if (catalogue.positions == PositionKind::kPixel || catalogue.stars.empty() ||
      length < kShortestMean * static_cast<double>(catalogue.stars.size())) {
    throw InputError({.file = catalogue.source,
                      .line = 0,
                      .parameter = "region",
                      .value = {},
                      .expected = "a centre and a radius, or a width and a height",
                      .message = "the stars have no common centre on the sky",
                      .suggestion = {}});
  }
  std::vector<Direction> directions;
  directions.reserve(catalogue.stars.size());
  for (const CatalogueStar& star : catalogue.stars) directions.push_back(to_direction(star.sky));
  SkyRegion cap;
  cap.centre = to_sky_position(smallest_enclosing_centre(directions, sum));
  for (const CatalogueStar& star : catalogue.stars) {
    cap.radius = std::max(cap.radius, angular_separation(cap.centre, star.sky));
  }
  return cap;
}

}  // namespace astroid
