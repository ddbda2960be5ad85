#include "astroid/catalogues/sky_brightness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "astroid/catalogues/passbands.hpp"
#include "astroid/core/camera_groups.hpp"
#include "astroid/core/detector_noise.hpp"
#include "astroid/core/ecliptic.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"
#include "astroid/core/photometric.hpp"
#include "astroid/core/run_time.hpp"
#include "astroid/core/sphere.hpp"
#include "astroid/core/throughput.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kNone = 0.0;  // too near to the Sun for the table
constexpr std::array<double, 11> kLatitudes{0, 5, 10, 15, 20, 25, 30, 45, 60, 75, 90};
constexpr std::array<double, 19> kLongitudes{0,  5,  10, 15,  20,  25,  30,  35,  40, 45,
                                             60, 75, 90, 105, 120, 135, 150, 165, 180};
constexpr double kUnitsPerS10 = 1.28;
/// 1e-8 W m^-2 sr^-1 um^-1 at 500 nm: rows by longitude from the Sun, columns by latitude. @source Leinert1998 Table 17
constexpr std::array<std::array<double, kLatitudes.size()>, kLongitudes.size()> kZodiacalLight{{
    {kNone, kNone, kNone, 3140, 1610, 985, 640, 275, 150, 100, 77},
    {kNone, kNone, kNone, 2940, 1540, 945, 625, 271, 150, 100, 77},
    {kNone, kNone, 4740, 2470, 1370, 865, 590, 264, 148, 100, 77},
    {11500, 6780, 3440, 1860, 1110, 755, 525, 251, 146, 100, 77},
    {6400, 4480, 2410, 1410, 910, 635, 454, 237, 141, 99, 77},
    {3840, 2830, 1730, 1100, 749, 545, 410, 223, 136, 97, 77},
    {2480, 1870, 1220, 845, 615, 467, 365, 207, 131, 95, 77},
    {1650, 1270, 910, 680, 510, 397, 320, 193, 125, 93, 77},
    {1180, 940, 700, 530, 416, 338, 282, 179, 120, 92, 77},
    {910, 730, 555, 442, 356, 292, 250, 166, 116, 90, 77},
    {505, 442, 352, 292, 243, 209, 183, 134, 104, 86, 77},
    {338, 317, 269, 227, 196, 172, 151, 116, 93, 82, 77},
    {259, 251, 225, 193, 166, 147, 132, 104, 86, 79, 77},
    {212, 210, 197, 170, 150, 133, 119, 96, 82, 77, 77},
    {188, 186, 177, 154, 138, 125, 113, 90, 77, 74, 77},
    {179, 178, 166, 147, 134, 122, 110, 90, 77, 73, 77},
    {179, 178, 165, 148, 137, 127, 116, 96, 79, 72, 77},
    {196, 192, 179, 165, 151, 141, 131, 104, 82, 72, 77},
    {230, 212, 195, 178, 163, 148, 134, 105, 83, 72, 77},
}};

/// The interval of a table that holds a value, and how far into it.
struct Place {
  std::size_t below;
  double part;
};
template <std::size_t N>
Place place_in(const std::array<double, N>& nodes, double value) {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, value);
  const auto below = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {below, std::clamp((value - nodes[below]) / (nodes[below + 1] - nodes[below]), 0.0, 1.0)};
}

constexpr double kArcsecPerDegree = 3600.0;

}  // namespace

S10 zodiacal_light(Degrees from_sun, Degrees latitude) {
  const double wrapped = wrap_degrees(from_sun.value());
  const Place i = place_in(kLongitudes, std::min(wrapped, 360.0 - wrapped));
  const Place j = place_in(kLatitudes, std::fabs(latitude.value()));
  double logarithm = 0.0;
  for (const std::size_t di : {0U, 1U})
    for (const std::size_t dj : {0U, 1U}) {
      const double weight = (di == 1 ? i.part : 1.0 - i.part) * (dj == 1 ? j.part : 1.0 - j.part);
      const double value = kZodiacalLight[i.below + di][j.below + dj];
      if (weight == 0.0) continue;
      if (value == kNone)
        throw InputError(Problem{.parameter = "StellarField/SkyModel",
                                 .value = "zodiacal",
                                 .expected = "a direction farther from the Sun than about 15 deg",
                                 .message = fmt::format("the table of the zodiacal light has nothing {:.1f} deg in "
                                                        "longitude and {:.1f} deg in latitude from the Sun",
                                                        from_sun.value(), latitude.value())});
      logarithm += weight * det::log(value / kUnitsPerS10);
    }
  return {det::exp(logarithm)};
}

S10 zodiacal_light(SkyPosition direction, double mjd) {
  const SphericalPosition ecliptic = to_ecliptic(direction);
  const double sun = to_degrees(earth_place(mjd).longitude).value() + 180.0;
  return zodiacal_light(Degrees(ecliptic.longitude.value() - sun), ecliptic.latitude);
}

S10 unresolved_starlight(SkyPosition direction) {
  const SphericalPosition galactic = to_galactic(direction);
  const double l = std::min(galactic.longitude.value(), 360.0 - galactic.longitude.value());
  const double brightness_i =
      18.97338 + 8.833 * std::fabs(galactic.latitude.value()) / 40.0 + 4.007 * det::pow(l / 180.0, 0.805);
  constexpr double kSolarColour = 0.70;  // V - I
  constexpr double kUnit = 10.0;         // V of the stars that S10 counts
  const double relative = flux_ratio(DeltaMag(brightness_i + kSolarColour - kUnit));
  return {relative * kArcsecPerDegree * kArcsecPerDegree};
}

ElectronsPerSecond rate_of_one_s10(const Mission& mission) {
  StarCatalogue sun;
  sun.source = "the solar colour of the sky";
  sun.passband = "V";
  sun.colour_index = "B-V";
  CatalogueStar star;
  star.magnitude = Magnitude(10.0);
  star.colour = 0.65;
  star.teff = 5778.0;
  sun.stars.push_back(star);
  convert_passband(sun, mission.telescope.zero_point_passband, {});
  const double side = mission.ccd.pixel_scale.value() / kArcsecPerDegree;
  return side * side * electron_rate(sun.stars[0].magnitude, mission.telescope.zero_point);
}

ElectronsPerSecond sky_rate(const Mission& mission, ElectronsPerSecond rate, SkyPosition direction, Seconds time) {
  const StellarFieldSettings& field = mission.field;
  if (field.sky == SkyModel::kConstant) return field.sky_background;
  const double mjd = mission.simulation.start_mjd + time.value() / kSecondsPerDay;
  const double stars = field.unresolved_stars >= 0.0 ? field.unresolved_stars : unresolved_starlight(direction).value;
  return (zodiacal_light(direction, mjd).value + stars) * rate;
}

ElectronsPerSecond mean_background_rate(const Mission& mission) {
  const bool constant = mission.field.sky == SkyModel::kConstant;
  const SkyPosition axis = camera_boresight(mission).axis;
  const ElectronsPerSecond sky = sky_rate(mission, constant ? ElectronsPerSecond(0.0) : rate_of_one_s10(mission), axis,
                                          middle_of_run(mission.simulation));
  return mean_throughput(mission) * (sky + mission.field.stray_light.level);
}

PixelNoise expected_pixel_noise(const Mission& mission) {
  return expected_pixel_noise(mission, mean_background_rate(mission));
}

}  // namespace astroid
