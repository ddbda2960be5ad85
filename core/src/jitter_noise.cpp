#include "astroid/core/jitter_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

// Variance of the average over a time a (in units of tau) of a unit process: 2 (a - 1 + e^-a) / a^2.
double averaged_variance(double a) {
  constexpr double kSeries =
      1e-2;  // where the cancellation of the closed form and the series' next term are both below 5e-14
  if (a < kSeries) return 1.0 - a / 3.0 * (1.0 - a / 4.0 * (1.0 - a / 5.0 * (1.0 - a / 6.0)));
  return 2.0 * (a + det::expm1(-a)) / (a * a);
}

// Covariance of two such averages, apart from e^(-distance / tau): (2 sinh(a/2) / a)^2.
double averaged_covariance(double a) {
  if (a == 0.0) return 1.0;
  const double root = (det::expm1(0.5 * a) - det::expm1(-0.5 * a)) / a;
  return root * root;
}

}  // namespace

double aperture_gradient(std::span<const double> weights, std::span<const double> fractions,
                         std::span<const double> gradient) {
  ASTROID_CHECK_EQ(weights.size(), fractions.size());
  ASTROID_CHECK_EQ(weights.size(), gradient.size());
  double flux = 0.0;
  double slope = 0.0;
  for (std::size_t n = 0; n < weights.size(); ++n) {
    flux += weights[n] * fractions[n];
    slope += weights[n] * gradient[n];
  }
  return slope / flux;
}

double jitter_noise(double gx, double gy, double sx, double sy) {
  return det::hypot(gx * sx, gy * sy);
}

double jittered_sigma(double sigma, double rms) {
  return det::hypot(sigma, rms);
}

double prnu_jitter_noise(double prnu, std::span<const double> dpdx, std::span<const double> dpdy, double sx,
                         double sy) {
  ASTROID_CHECK_EQ(dpdx.size(), dpdy.size());
  double sum = 0.0;
  for (std::size_t n = 0; n < dpdx.size(); ++n) {
    const double x = sx * dpdx[n];
    const double y = sy * dpdy[n];
    sum += x * x + y * y;
  }
  return prnu * std::sqrt(sum);
}

double prnu_static_noise(double prnu, std::span<const double> fractions) {
  double sum = 0.0;
  for (const double p : fractions) sum += p * p;
  return prnu * std::sqrt(sum);
}

double ou_mean_rms(double rms, Seconds tau, const Cadence& cadence) {
  const double duration = cadence.exposure_time / tau;
  const double step = cadence.cycle / tau;
  // Of motion much faster than an exposure the hyperbolic sine would overflow; its decaying half is below 1e-43 there.
  constexpr double kFast = 100.0;
  const bool fast = duration > kFast;
  const double covariance = fast ? 1.0 / (duration * duration) : averaged_covariance(duration);
  const double between = fast ? duration : 0.0;  // from here distances count from the end of an exposure
  const auto n = static_cast<double>(cadence.exposures);
  double sum = 0.0;
  for (long k = cadence.exposures - 1; k > 0; --k) {
    const auto lag = static_cast<double>(k);
    sum += (n - lag) * det::exp(between - lag * step);  // smallest first
  }
  return rms * std::sqrt((averaged_variance(duration) + 2.0 * covariance * sum / n) / n);
}

double ou_mean_covariance(Seconds tau, const Cadence& cadence, Seconds lag) {
  if (lag.value() == 0.0) {
    const double rms = ou_mean_rms(1.0, tau, cadence);
    return rms * rms;
  }
  const double duration = cadence.exposure_time / tau;
  const auto n = static_cast<double>(cadence.exposures);
  const double decayed = duration > 0.0 ? -det::expm1(-duration) / duration : 1.0;
  // h(t) - 1 without cancellation.
  const auto bend = [](double t) { return 0.5 * t * t * averaged_variance(t); };
  const auto covariance = [&](double distance) {
    if (distance >= duration) {
      const double root = decayed * det::exp(-0.5 * (distance - duration));
      return root * root;
    }
    return (bend(duration + distance) - 2.0 * bend(distance) + bend(duration - distance)) / (duration * duration);
  };
  double sum = 0.0;
  for (long k = cadence.exposures - 1; k >= 0; --k) {  // smallest first
    const double apart = static_cast<double>(k) * (cadence.cycle / tau);
    const double weight = n - static_cast<double>(k);
    sum += weight * covariance(std::fabs(apart + lag / tau));
    if (k > 0) sum += weight * covariance(std::fabs(apart - lag / tau));
  }
  return sum / (n * n);
}

double flat_field_static_noise(double rms, double exponent, double share) {
  return rms * std::pow(share, std::max(0.0, 1.0 - 0.5 * exponent));
}

}  // namespace astroid
