#include "astroid/core/photometric.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

constexpr double kTwoFifths = 0.4;
constexpr double kTwoFifthsRest = -2.220446049250313e-17;  // 0.4 minus the double 0.4
constexpr double kLnTen = 2.302585092994045684017991454684364208;

// Upper half of a double's digits (Dekker): products of two halves are exact.
double upper_half(double x) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double c = kSplitter * x;
  return c - (c - x);
}

// What rounding took from the product p = a * b. @source Dekker1971
double product_rest(double a, double b, double p) {
  const double ah = upper_half(a);
  const double al = a - ah;
  const double bh = upper_half(b);
  const double bl = b - bh;
  return ((ah * bh - p) + ah * bl + al * bh) + al * bl;
}

// 10^(-0.4 (difference + rest)) with an exponent of twice a double's digits.
double flux_ratio_of(double difference, double rest) {
  const double exponent = -kTwoFifths * difference;
  const double power = det::exp10(exponent);
  if (power == 0.0 || !std::isfinite(power)) return power;
  const double correction =
      product_rest(-kTwoFifths, difference, exponent) - kTwoFifthsRest * difference - kTwoFifths * rest;
  return power + power * (kLnTen * correction);
}

[[noreturn]] void refuse(const char* parameter, double value, const char* expected) {
  throw InputError(Problem{.parameter = parameter,
                           .value = fmt::format("{}", value),
                           .expected = expected,
                           .message = "no flux can be computed from it"});
}

}  // namespace

double flux_ratio(DeltaMag difference) {
  return flux_ratio_of(difference.value(), 0.0);
}

ElectronsPerSecond electron_rate(Magnitude magnitude, Magnitude zero_point) {
  const double m = magnitude.value();
  const double zp = zero_point.value();
  const double difference = m - zp;
  // What rounding took from the difference (Knuth's two-sum); not for infinities.
  const double part = m - difference;
  const double rest = std::isfinite(difference) ? (m - (difference + part)) + (part - zp) : 0.0;
  const double rate = flux_ratio_of(difference, rest);
  if (!std::isfinite(rate)) refuse("magnitude", m, "a number that gives a finite flux");
  return ElectronsPerSecond(rate);
}

std::optional<Magnitude> magnitude_of(ElectronsPerSecond rate, Magnitude zero_point) {
  if (!(rate.value() > 0.0) || !std::isfinite(rate.value())) return std::nullopt;
  return zero_point + DeltaMag(-2.5 * det::log10(rate.value()));
}

Magnitude zero_point(const Throughput& throughput) {
  const double rate = throughput.photon_flux * throughput.bandwidth * throughput.area * throughput.transmission *
                      throughput.quantum_efficiency;
  if (!(rate > 0.0) || !std::isfinite(rate)) refuse("throughput", rate, "a positive number of electrons per second");
  return Magnitude(2.5 * det::log10(rate));
}

DeltaMag magnitude_error(double signal_to_noise) {
  return DeltaMag(kPogson / signal_to_noise);
}

MagnitudeInterval magnitude_interval(double signal_to_noise) {
  const double error = 1.0 / signal_to_noise;
  return {DeltaMag(-kPogson * det::log1p(error)),
          DeltaMag(error < 1.0 ? -kPogson * det::log1p(-error) : std::numeric_limits<double>::infinity())};
}

DeltaMag mean_magnitude_bias(double mean_electrons) {
  return DeltaMag(kPogson / (2.0 * mean_electrons));
}

Magnitude asinh_magnitude(double relative_flux, double softening) {
  const double x = std::abs(relative_flux) / (2.0 * softening);
  // asinh without cancellation near 0 and without overflow far out.
  constexpr double kHuge = 1e150;
  const double asinh = x < kHuge ? det::log1p(x + x * x / (1.0 + std::sqrt(1.0 + x * x))) : det::log(x) + det::log(2.0);
  return Magnitude(-kPogson * (std::copysign(asinh, relative_flux) + det::log(softening)));
}

DeltaMag asinh_magnitude_error(double relative_flux, double relative_error, double softening) {
  const double width = 2.0 * softening;
  return DeltaMag(kPogson * relative_error / det::hypot(width, relative_flux));
}

double contaminant_ratio(double spr_total) {
  return spr_total / (1.0 - spr_total);
}

double spr_from_ratio(double contaminant_over_target) {
  return contaminant_over_target / (1.0 + contaminant_over_target);
}

double crowdsap(double spr_total) {
  return 1.0 - spr_total;
}

DeltaMag contamination_shift(double contaminant_over_target) {
  return DeltaMag(-kPogson * det::log1p(contaminant_over_target));
}

}  // namespace astroid
