#include "astroid/core/detector_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "astroid/core/digitise.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

bool is_cmos(const Mission& mission) {
  return mission.simulation.type == DetectorType::kCmos;
}

double quantisation(const Mission& mission) {
  return mission.ccd.gain.value() / kSqrt12;
}

/// Full well, or the end of the ADC's range: what one read can tell.
double largest_read(const Mission& mission) {
  const CcdSettings& ccd = mission.ccd;
  return std::min(ccd.full_well.value(), ((Adu(adc_top(ccd.adc_bits)) - ccd.bias) * ccd.gain).value());
}

}  // namespace

RampNoise ramp_noise(const Mission& mission) {
  if (!is_cmos(mission)) return {};
  return {.reads = mission.cmos.reads, .fit = mission.cmos.ramp_fit, .full_well = largest_read(mission)};
}

double read_variance(const Mission& mission) {
  const double readout = mission.ccd.readout_noise.value();
  return readout * readout + quantisation(mission) * quantisation(mission);
}

PixelNoise expected_pixel_noise(const Mission& mission, ElectronsPerSecond light) {
  const ElectronsPerSecond rate = light + mission.ccd.dark_current;
  PixelNoise noise{.background = (rate * mission.simulation.exposure_time).value(),
                   .readout = mission.ccd.readout_noise.value(),
                   .quantisation = quantisation(mission)};
  if (!is_cmos(mission)) return noise;
  noise.ramp = ramp_noise(mission);
  noise.column = mission.cmos.column_noise.value();
  noise.row = mission.cmos.row_noise.value();
  noise.side_coupling = mission.cmos.coupling;
  noise.corner_coupling = mission.cmos.corner_coupling;
  // A single read has the charge of its reset; a fit takes differences, which have not.
  if (mission.cmos.reads <= 1) noise.readout = det::hypot(noise.readout, mission.cmos.reset_noise.value());
  return noise;
}

double fitted_readout_factor(const Mission& mission) {
  const PixelNoise noise = expected_pixel_noise(mission, ElectronsPerSecond(0.0));
  return std::sqrt(noise.factors(0.0).readout);
}

int delivered_bits(const Mission& mission) {
  constexpr int kBitsOfAFloat = 24;
  const int bits = mission.ccd.adc_bits;
  if (!is_cmos(mission) || mission.cmos.reads <= 1) return bits;
  int more = 0;
  while ((1 << more) < mission.cmos.reads - 1) ++more;
  return std::max(bits, std::min(bits + more, kBitsOfAFloat));
}

double saturation_electrons(const Mission& mission) {
  const double read = largest_read(mission);
  return is_cmos(mission) && mission.cmos.reads > 1 ? read * (mission.cmos.reads - 1) : read;
}

InterPixelCoupling pixel_coupling(const CmosSettings& cmos) {
  return {.side = cmos.coupling, .corner = cmos.corner_coupling};
}

std::shared_ptr<const PixelPsf> imaged_psf(const Mission& mission, std::shared_ptr<const PixelPsf> psf) {
  const InterPixelCoupling coupling = pixel_coupling(mission.cmos);
  if (!is_cmos(mission) || coupling.own() >= 1.0) return psf;
  return make_coupled_psf(std::move(psf), coupling);
}

double pixel_response_rms(const Mission& mission) {
  return is_cmos(mission) ? det::hypot(mission.ccd.prnu, mission.cmos.gain_rms) : mission.ccd.prnu;
}

}  // namespace astroid
