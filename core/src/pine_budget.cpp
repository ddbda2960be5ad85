#include "astroid/core/pine_budget.hpp"

#include <cmath>
#include <initializer_list>

#include "astroid/core/photometric.hpp"

namespace astroid {

namespace {

constexpr double kPpm = 1e6;

Ppm quadratic_sum(std::initializer_list<Ppm> terms) {
  double sum = 0.0;
  for (const Ppm term : terms) sum += term.value() * term.value();
  return Ppm(std::sqrt(sum));
}

}  // namespace

PineBudget pine_budget(Magnitude v, double cameras, const PineParameters& in) {
  const double brightness = flux_ratio(v - in.reference);
  const double star = in.mask_electrons * brightness;
  const double peak = in.peak_electrons * brightness;
  const double measurements = cameras * in.exposures;
  const double per_mask = std::sqrt(in.mask_pixels / measurements);
  const double background = ((in.sky + in.stray_light) * in.exposure_time).value() + in.contaminants * peak;
  const double smear = (in.smearing * in.transfer_time).value();
  PineBudget out;
  out.photon = Ppm(kPpm / std::sqrt(star * measurements));
  out.ccd_readout = Ppm(kPpm * in.ccd_readout_noise / star * per_mask);
  out.fee_readout = Ppm(kPpm * in.fee_readout_noise / star * per_mask);
  out.other_photons = Ppm(kPpm * std::sqrt(background) / peak * in.peak_fraction * per_mask);
  out.smearing = Ppm(kPpm * std::sqrt(smear) / peak * in.peak_fraction * per_mask);
  out.jitter = Ppm(in.jitter_density * std::sqrt(in.jitter_bandwidth));
  out.breathing = Ppm(in.breathing / std::sqrt(measurements));
  out.offset =
      Ppm(kPpm * in.offset_stability / peak * in.peak_fraction * in.offset_independence / std::sqrt(measurements));
  out.random = quadratic_sum({out.ccd_readout, out.fee_readout, out.other_photons, out.smearing});
  out.systematic = quadratic_sum({out.jitter, out.breathing, out.offset});
  out.photon_and_random = quadratic_sum({out.photon, out.random});
  out.total = quadratic_sum({out.photon_and_random, out.systematic});
  return out;
}

}  // namespace astroid
