#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "astroid/catalogues/synthetic_field.hpp"
#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "star_process.hpp"

namespace astroid {

namespace {

constexpr double kBin = 0.25;                  // mag, of counts
constexpr double kSlopeWindow = 2.0;           // mag brighter than complete_to, over which a slope is fitted
constexpr std::int64_t kFewestForSlope = 100;  // stars in that window: a slope good to 0.08
constexpr double kFlattestSlope = 1e-3;
constexpr double kSteepestSlope = 2.0;

InputError refusal(const StarCatalogue& catalogue, const std::string& parameter, const std::string& message,
                   const std::string& expected) {
  return InputError({.file = catalogue.source,
                     .line = 0,
                     .parameter = parameter,
                     .value = {},
                     .expected = expected,
                     .message = message,
                     .suggestion = {}});
}

std::vector<double> magnitudes_in(const StarCatalogue& catalogue, const SkyRegion& region) {
  std::vector<double> magnitudes;
  for (const CatalogueStar& star : catalogue.stars) {
    if (contains(region, star.sky)) magnitudes.push_back(star.magnitude.value());
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

std::int64_t brighter_than(std::span<const double> sorted, double magnitude) {
  return std::upper_bound(sorted.begin(), sorted.end(), magnitude) - sorted.begin();
}

/// The bright edge of the fullest bin of the counts: they rise up to there, so few stars can be missing before.
double turn_over(std::span<const double> magnitudes) {
  std::map<std::int64_t, std::int64_t> counts;
  for (const double m : magnitudes) ++counts[static_cast<std::int64_t>(std::floor(m / kBin))];
  const auto fullest =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return static_cast<double>(fullest->first) * kBin;
}

/// Mean of t in 0 .. 1 when its density falls as exp(-k t).
double mean_of_truncated_exponential(double k) {
  return 1.0 / k - 1.0 / det::expm1(k);
}

/// Maximum likelihood of the slope from the stars of the window alone, so that a bright limit does no harm: with
/// t = (complete_to - m) / window, density exp(-k t) and k = slope ln(10) window, the mean of t is what k says it is.
void fit_slope(const StarCatalogue& catalogue, std::span<const double> magnitudes, ExtensionLaw& law) {
  const double end = law.complete_to.value();
  double sum = 0.0;
  std::int64_t stars = 0;
  for (const double m : magnitudes) {
    if (m > end || m <= end - kSlopeWindow) continue;
    sum += (end - m) / kSlopeWindow;
    ++stars;
  }
  if (stars < kFewestForSlope) {
    throw refusal(catalogue, "slope",
                  fmt::format("only {} stars have magnitudes {:.2f} .. {:.2f}: too few for a slope of the counts",
                              stars, end - kSlopeWindow, end),
                  fmt::format("at least {}, or a stated slope", kFewestForSlope));
  }
  const double mean = sum / static_cast<double>(stars);
  const double per_slope = kSlopeWindow * det::log(10.0);
  double low = kFlattestSlope * per_slope;
  double high = kSteepestSlope * per_slope;
  constexpr int kHalvings = 60;  // to the last bit
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (mean_of_truncated_exponential(middle) > mean ? low : high) = middle;
  }
  law.slope = low / per_slope;
  const double grown = det::expm1(low);
  const double variance = 1.0 / (low * low) - (grown + 1.0) / (grown * grown);
  law.slope_error = 1.0 / std::sqrt(static_cast<double>(stars) * variance) / per_slope;
}

/// Expected stars between complete_to and m.
double expected_to(const ExtensionLaw& law, double m) {
  return static_cast<double>(law.stars) * (det::exp10(law.slope * (m - law.complete_to.value())) - 1.0);
}

double magnitude_at(const ExtensionLaw& law, double expected) {
  return law.complete_to.value() + det::log10(1.0 + expected / static_cast<double>(law.stars)) / law.slope;
}

/// Fraction of the law's stars that the catalogue lacks, for every bin fainter than complete_to; 1 beyond them.
std::vector<double> missing_fractions(std::span<const double> magnitudes, const ExtensionLaw& law) {
  std::vector<double> fractions;
  const double start = law.complete_to.value();
  while (!magnitudes.empty() && start + static_cast<double>(fractions.size()) * kBin <= magnitudes.back()) {
    const double low = start + static_cast<double>(fractions.size()) * kBin;
    const auto there = static_cast<double>(brighter_than(magnitudes, low + kBin) - brighter_than(magnitudes, low));
    const double wanted = expected_to(law, low + kBin) - expected_to(law, low);
    fractions.push_back(std::max(0.0, 1.0 - there / wanted));
  }
  return fractions;
}

void add_missing(StarCatalogue& catalogue, const ExtensionRequest& request, std::span<const double> missing,
                 ExtensionLaw& law) {
  const StarProcess process(request.seed);
  const double end = expected_to(law, request.faint.value());
  double arrived = 0.0;
  for (std::uint64_t n = 1;; ++n) {
    arrived += process.gap(n);
    if (arrived > end) break;
    const double magnitude = magnitude_at(law, arrived);
    const auto bin = static_cast<std::size_t>(std::max(0.0, (magnitude - law.complete_to.value()) / kBin));
    if (bin < missing.size() && process.chance(n) >= missing[bin]) continue;
    CatalogueStar star;
    star.id = fmt::format("ext{}-{}", request.seed, n);
    star.sky = process.position(n, law.region);
    star.magnitude = Magnitude(std::max(rounded_magnitude(magnitude), law.complete_to.value() + kMagnitudeStep));
    star.colour = std::numeric_limits<double>::quiet_NaN();
    star.teff = std::numeric_limits<double>::quiet_NaN();
    catalogue.stars.push_back(std::move(star));
    ++law.added;
  }
}

bool is_empty(const SkyRegion& region) {
  return region.radius.value() == 0.0 && region.width.value() == 0.0 && region.height.value() == 0.0;
}

void check_kind(const StarCatalogue& catalogue) {
  if (catalogue.positions == PositionKind::kPixel || catalogue.brightness == BrightnessKind::kElectrons) {
    throw refusal(catalogue, "catalogue", "only positions on the sky with magnitudes can be extended",
                  "columns ra, dec and mag");
  }
  if (catalogue.stars.empty()) throw refusal(catalogue, "catalogue", "there are no stars to extend", "some");
}

}  // namespace

ExtensionLaw extend_catalogue(StarCatalogue& catalogue, const ExtensionRequest& request) {
  check_kind(catalogue);
  ExtensionLaw law;
  law.region = is_empty(request.region) ? enclosing_cap(catalogue) : request.region;
  const double area = square_degrees(law.region);
  const std::vector<double> magnitudes = magnitudes_in(catalogue, law.region);
  if (magnitudes.empty()) throw refusal(catalogue, "region", "no star of the catalogue is in it", "another region");
  law.complete_to = request.complete_to.value_or(Magnitude(turn_over(magnitudes)));
  if (!request.complete_to) {
    catalogue.notes.push_back(
        fmt::format("WARNING: complete to {:.2f} by the turn-over of the counts; state the magnitude if it is known",
                    law.complete_to.value()));
  }
  law.stars = brighter_than(magnitudes, law.complete_to.value());
  if (law.stars < 1) {
    throw refusal(catalogue, "complete_to", fmt::format("no star is brighter than {}", law.complete_to.value()),
                  "a magnitude that the catalogue reaches");
  }
  if (request.slope) {
    law.slope = *request.slope;
  } else {
    fit_slope(catalogue, magnitudes, law);
  }
  if (!(law.slope > 0.0 && law.slope <= kSteepestSlope)) {
    throw refusal(catalogue, "slope", fmt::format("{} is no slope of star counts", shortest_text(law.slope)),
                  "above 0, up to 2 per magnitude");
  }
  if (!(expected_to(law, request.faint.value()) <= kMostSyntheticStars)) {
    throw refusal(catalogue, "faint", fmt::format("{} would add too many stars", request.faint.value()),
                  "at most 1e8 stars");
  }
  add_missing(catalogue, request, missing_fractions(magnitudes, law), law);
  catalogue.notes.push_back(
      fmt::format("extended: {} stars added in {} {:.2f} .. {:.2f}; stars brighter than m in {:.6g} deg^2 around ra "
                  "{:.6f}, dec {:.6f} "
                  "deg: {} 10^({:.4f} (m - {:.2f})), slope {}; seed {}",
                  law.added, catalogue.passband, law.complete_to.value(), request.faint.value(), area,
                  law.region.centre.ra, law.region.centre.dec, law.stars, law.slope, law.complete_to.value(),
                  request.slope ? "given" : fmt::format("fitted, +- {:.4f}", law.slope_error), request.seed));
  return law;
}

}  // namespace astroid
