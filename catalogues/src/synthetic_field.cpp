#include "astroid/catalogues/synthetic_field.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "astroid/catalogues/passbands.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "problem_list.hpp"
#include "star_process.hpp"

namespace astroid {

namespace {

constexpr double kSteepestSlope = 2.0;  // of log N per magnitude; counts of the sky stay below 0.6

Problem request_problem(const char* parameter, const std::string& value, const char* expected, const char* message) {
  return {.file = {},
          .line = 0,
          .parameter = parameter,
          .value = value,
          .expected = expected,
          .message = message,
          .suggestion = {}};
}

void check(const FieldRequest& request) {
  constexpr std::size_t kAll = 100;
  ProblemList problems({}, kAll);
  if (!(request.slope > 0.0 && request.slope <= kSteepestSlope)) {
    problems.add(
        request_problem("slope", shortest_text(request.slope), "above 0, up to 2 per magnitude", "out of range"));
  }
  if (!(request.bright < request.faint)) {
    problems.add(request_problem("faint", shortest_text(request.faint.value()), "fainter than the bright limit",
                                 "the magnitude limits leave no room"));
  }
  if (request.stars.has_value() == request.density.has_value()) {
    problems.add(
        request_problem("density", "", "either a number of stars or a density", "how many stars is not clear"));
  }
  if (request.stars && !(*request.stars > 0 && static_cast<double>(*request.stars) <= kMostSyntheticStars)) {
    problems.add(request_problem("stars", std::to_string(*request.stars), "1 .. 1e8", "out of range"));
  }
  if (request.density && !(*request.density > 0.0 && std::isfinite(*request.density))) {
    problems.add(
        request_problem("density", shortest_text(*request.density), "above 0 per square degree", "out of range"));
  }
  problems.throw_if_any();
}

/// Expected stars brighter than m: scale 10^(slope (m - anchor)), less those brighter than `bright`.
struct Law {
  double scale;
  double anchor;
  double slope;
  double bright;

  [[nodiscard]] double cut() const { return det::exp10(slope * (bright - anchor)); }
  [[nodiscard]] double brighter_than(double m) const { return scale * (det::exp10(slope * (m - anchor)) - cut()); }
  [[nodiscard]] double magnitude_at(double count) const { return anchor + det::log10(count / scale + cut()) / slope; }
};

void add_star(StarCatalogue& field, const StarProcess& process, const FieldRequest& request, double magnitude) {
  const std::uint64_t n = field.stars.size() + 1;
  CatalogueStar star;
  star.id = fmt::format("syn{}-{}", request.seed, n);
  star.sky = process.position(n, request.region);
  star.magnitude = Magnitude(rounded_magnitude(magnitude));
  star.colour = std::numeric_limits<double>::quiet_NaN();
  star.teff = std::numeric_limits<double>::quiet_NaN();
  field.stars.push_back(std::move(star));
}

void add_poisson_number(StarCatalogue& field, const StarProcess& process, const FieldRequest& request, const Law& law) {
  const double expected = law.brighter_than(request.faint.value());
  if (!(expected <= kMostSyntheticStars)) {
    throw InputError(request_problem("density", shortest_text(*request.density), "at most 1e8 stars in the field",
                                     "the field would hold too many stars"));
  }
  double arrived = process.gap(1);
  while (arrived <= expected) {
    add_star(field, process, request, law.magnitude_at(arrived));
    arrived += process.gap(field.stars.size() + 1);
  }
}

void add_exact_number(StarCatalogue& field, const StarProcess& process, const FieldRequest& request, const Law& law) {
  // The arrivals of a Poisson process, scaled so that arrival N + 1 falls on the end, are N sorted uniforms.
  const auto stars = static_cast<std::uint64_t>(*request.stars);
  double all = 0.0;
  for (std::uint64_t n = 1; n <= stars + 1; ++n) all += process.gap(n);
  double arrived = 0.0;
  field.stars.reserve(stars);
  for (std::uint64_t n = 1; n <= stars; ++n) {
    arrived += process.gap(n);
    add_star(field, process, request, law.magnitude_at(static_cast<double>(stars) * (arrived / all)));
  }
}

std::string describe(const SkyRegion& region) {
  const std::string centre = fmt::format("ra {}, dec {} deg", region.centre.ra, region.centre.dec);
  if (region.radius.value() != 0.0) return fmt::format("within {} deg of {}", region.radius.value(), centre);
  return fmt::format("{} x {} deg around {}", region.width.value(), region.height.value(), centre);
}

}  // namespace

StarCatalogue make_synthetic_field(const FieldRequest& request) {
  check(request);
  const double area = square_degrees(request.region);
  Law law{.scale = 1.0, .anchor = request.faint.value(), .slope = request.slope, .bright = request.bright.value()};
  if (request.stars) {
    law.scale = static_cast<double>(*request.stars) / (1.0 - law.cut());
  } else {
    law.scale = *request.density * area;
    law.anchor = request.density_limit.value();
  }
  StarCatalogue field;
  field.source = "synthetic field";
  field.passband = canonical_passband(request.passband);
  const StarProcess process(request.seed);
  if (request.stars) {
    add_exact_number(field, process, request, law);
  } else {
    add_poisson_number(field, process, request, law);
  }
  field.notes.push_back(
      fmt::format("synthetic: {} stars {} ({:.6g} deg^2), {} {} .. {}; stars per deg^2 brighter than m: {:.6g} 10^({} "
                  "(m - {})), less "
                  "those brighter than {}; seed {}",
                  field.stars.size(), describe(request.region), area, field.passband, request.bright.value(),
                  request.faint.value(), law.scale / area, law.slope, law.anchor, law.bright, request.seed));
  return field;
}

}  // namespace astroid
