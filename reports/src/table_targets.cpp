#include "astroid/reports/tables.hpp"

namespace astroid {

namespace {

using TargetColumn = Column<TargetMetrics>;

TargetColumn number(std::string name, std::string unit, std::string meaning, double TargetMetrics::*member) {
  return {std::move(name), std::move(unit), std::move(meaning),
          [member](const TargetMetrics& t) { return Cell(t.*member); }};
}

TargetColumn predicted(std::string name, std::string meaning, double PredictedNoise::*member) {
  return {std::move(name), "ppm", std::move(meaning),
          [member](const TargetMetrics& t) { return Cell(t.predicted.*member); }};
}

TargetColumn cause(const std::string& name, std::string meaning, double NoiseByCause::*member) {
  return {"nsr_1h_" + name + "_ppm", "ppm", std::move(meaning),
          [member](const TargetMetrics& t) { return Cell(t.predicted.bin.*member); }};
}

TargetColumn estimate(std::string name, std::string unit, std::string meaning, NoiseEstimate TargetMetrics::*which,
                      double NoiseEstimate::*part = &NoiseEstimate::value) {
  return {std::move(name), std::move(unit), std::move(meaning),
          [which, part](const TargetMetrics& t) { return Cell((t.*which).*part); }};
}

TargetColumn magnitude_cause(std::string name, std::string meaning, double MagnitudeCauses::*member) {
  return {std::move(name), "mag", std::move(meaning),
          [member](const TargetMetrics& t) { return Cell(t.causes.*member); }};
}

void add_star(std::vector<TargetColumn>& c) {
  c.push_back({"id", "", "the star's identifier in the catalogue", [](const TargetMetrics& t) { return Cell(t.id); }});
  c.push_back(number("mag", "mag", "true magnitude, in the passband of the zero point", &TargetMetrics::mag));
  c.push_back(
      number("x", "px", "true column at the nominal pointing; the centre of the first pixel is 0", &TargetMetrics::x));
  c.push_back(
      number("y", "px", "true row at the nominal pointing; the centre of the first pixel is 0", &TargetMetrics::y));
  c.push_back({"mask_pixels", "px", "pixels of the aperture with weight",
               [](const TargetMetrics& t) { return Cell(std::int64_t{t.mask_pixels}); }});
  c.push_back(number("enclosed_fraction", "", "share of the target's flux that the aperture collects, sum w p",
                     &TargetMetrics::enclosed_fraction));
  c.push_back(number("spr_tot", "",
                     "stellar pollution ratio: neighbours' share of all star light in the aperture, sky excluded",
                     &TargetMetrics::spr_tot));
  c.push_back(number("crowdsap", "", "target's share of all star light in the aperture, 1 - spr_tot",
                     &TargetMetrics::crowdsap));
  c.push_back(
      number("flfrcsap", "", "target's flux in the aperture / all flux of the target", &TargetMetrics::flfrcsap));
}

void add_exposure_noise(std::vector<TargetColumn>& c) {
  c.push_back(number("nsr_exposure", "",
                     "predicted noise-to-signal ratio of one exposure of one camera, jitter included, relative to the "
                     "target's flux in the aperture",
                     &TargetMetrics::nsr_exposure));
  c.push_back(estimate("nsr_exposure_measured", "",
                       "the same, measured: standard deviation over all exposures (mean of the simulated cameras)",
                       &TargetMetrics::nsr_exposure_measured));
  c.push_back(estimate("nsr_exposure_measured_err", "", "its standard error", &TargetMetrics::nsr_exposure_measured,
                       &NoiseEstimate::error));
}

void add_hour_noise(std::vector<TargetColumn>& c) {
  const auto value = &NoiseEstimate::value;
  const auto error = &NoiseEstimate::error;
  const auto low = &NoiseEstimate::low;
  const auto high = &NoiseEstimate::high;
  c.push_back(number("nsr_1h_ppm", "ppm",
                     "predicted noise of the mean over one bin (Analysis/Bin, 1 h unless set) with all cameras: "
                     "independent terms fall by the root of their number, "
                     "jitter by the motion that is left in the mean",
                     &TargetMetrics::nsr_1h_ppm));
  c.push_back(estimate(
      "nsr_1h_ppm_measured", "ppm",
      "the same, measured: standard deviation of the bin means / c4, its independent part scaled to all cameras",
      &TargetMetrics::nsr_1h_scaled, value));
  c.push_back(estimate("nsr_1h_ppm_measured_err", "ppm", "its standard error", &TargetMetrics::nsr_1h_scaled, error));
  c.push_back(estimate("nsr_1h_ppm_within_measured", "ppm",
                       "measured from the scatter within bins / sqrt(n), each with its c4, scaled to all "
                       "cameras; blind to noise slower than a bin",
                       &TargetMetrics::nsr_1h_within_scaled, value));
  c.push_back(estimate("nsr_1h_ppm_within_measured_err", "ppm", "its standard error",
                       &TargetMetrics::nsr_1h_within_scaled, error));
  c.push_back(predicted("nsr_1h_simulated_ppm", "predicted with the cameras that were simulated",
                        &PredictedNoise::bin_simulated));
  c.push_back(estimate("nsr_1h_simulated_ppm_measured", "ppm", "measured with the cameras that were simulated",
                       &TargetMetrics::nsr_1h_measured, value));
  c.push_back(estimate("nsr_1h_simulated_ppm_measured_err", "ppm", "its standard error",
                       &TargetMetrics::nsr_1h_measured, error));
  c.push_back(estimate("nsr_1h_simulated_ppm_uncorrected", "ppm",
                       "the same before jitter correction; nothing where there is none",
                       &TargetMetrics::nsr_1h_uncorrected, value));
  c.push_back(estimate("nsr_1h_simulated_ppm_cotrended", "ppm",
                       "what cotrending leaves of it; nothing where there is none", &TargetMetrics::nsr_1h_cotrended,
                       value));
  c.push_back(estimate("nsr_1h_simulated_ppm_measured_low", "ppm", "lower end of its 95 % interval (chi-squared)",
                       &TargetMetrics::nsr_1h_measured, low));
  c.push_back(estimate("nsr_1h_simulated_ppm_measured_high", "ppm", "upper end of its 95 % interval (chi-squared)",
                       &TargetMetrics::nsr_1h_measured, high));
  c.push_back(predicted("nsr_1h_simulated_within_ppm",
                        "what the scatter within bins should give with the cameras that were simulated",
                        &PredictedNoise::bin_within));
  c.push_back(estimate("nsr_1h_simulated_within_ppm_measured", "ppm", "what it gave",
                       &TargetMetrics::nsr_1h_within_measured, value));
  c.push_back(estimate("nsr_1h_simulated_within_ppm_measured_err", "ppm", "its standard error",
                       &TargetMetrics::nsr_1h_within_measured, error));
}

void add_causes(std::vector<TargetColumn>& c) {
  c.push_back(cause("photon", "part of nsr_1h_ppm: photon noise of the target", &NoiseByCause::photon));
  c.push_back(
      cause("contaminants", "part of nsr_1h_ppm: photon noise of all other stars", &NoiseByCause::contaminants));
  c.push_back(
      cause("background", "part of nsr_1h_ppm: photon noise of sky and dark current", &NoiseByCause::background));
  c.push_back(cause("readout", "part of nsr_1h_ppm: readout noise", &NoiseByCause::readout));
  c.push_back(cause("quantisation", "part of nsr_1h_ppm: rounding by the ADC", &NoiseByCause::quantisation));
  c.push_back(cause("background_estimate", "part of nsr_1h_ppm: noise of the local background that is subtracted",
                    &NoiseByCause::background_estimate));
  c.push_back(
      cause("jitter",
            "part of nsr_1h_ppm: pointing jitter moving light across the edge of the aperture; common to all cameras",
            &NoiseByCause::jitter));
  c.push_back(cause("prnu_jitter", "part of nsr_1h_ppm: pointing jitter moving the star over unequal pixels",
                    &NoiseByCause::prnu_jitter));
  c.push_back(cause(
      "smearing", "part of nsr_1h_ppm: photon noise of what is smeared along the columns, and noise of its correction",
      &NoiseByCause::smearing));
  c.push_back(cause("bias", "part of nsr_1h_ppm: noise of a measured bias, and offsets of rows", &NoiseByCause::bias));
  c.push_back(
      cause("drift", "part of nsr_1h_ppm: slow changes of gain and bias; common to all cameras", &NoiseByCause::drift));
}

void add_recovery(std::vector<TargetColumn>& c) {
  c.push_back(number("flux_in", "e-", "true electrons per exposure, all of the PSF", &TargetMetrics::flux_in));
  c.push_back(number("flux_expected", "e-",
                     "expected electrons per exposure in the aperture: target, neighbours, and what is smeared into it",
                     &TargetMetrics::flux_expected));
  c.push_back(number("flux_measured", "e-", "measured electrons per exposure in the aperture, mean over all exposures",
                     &TargetMetrics::flux_measured));
  c.push_back(number("flux_err", "e-",
                     "standard error of flux_measured: from bin means with 10 bins or more, else from exposures",
                     &TargetMetrics::flux_err));
  c.push_back(number("mag_measured", "mag", "magnitude of flux_measured; nan unless it is positive",
                     &TargetMetrics::mag_measured));
  c.push_back(number("mag_err", "mag", "its standard error, 1.0857 flux_err / flux_measured", &TargetMetrics::mag_err));
  c.push_back(number("delta_mag", "mag",
                     "mag_measured - mag = delta_contamination + delta_aperture_loss + delta_smearing + delta_residual",
                     &TargetMetrics::delta_mag));
  c.push_back(magnitude_cause("delta_contamination", "2.5 log10(1 - spr_tot): neighbours brighten",
                              &MagnitudeCauses::contamination));
  c.push_back(magnitude_cause("delta_aperture_loss", "-2.5 log10(enclosed_fraction): light outside the aperture",
                              &MagnitudeCauses::aperture_loss));
  c.push_back(magnitude_cause("delta_smearing", "light that is smeared along the columns and not corrected brightens",
                              &MagnitudeCauses::smearing));
  c.push_back(magnitude_cause("delta_residual",
                              "what none of these explains: saturation, background, calibration, noise",
                              &MagnitudeCauses::residual));
  c.push_back(number("delta_prnu_rms", "mag",
                     "expected rms of delta_residual by fixed unequal pixels and the flat field",
                     &TargetMetrics::prnu_magnitude));
  c.push_back(number("delta_neighbours_rms", "mag",
                     "rms of delta_residual if neighbours are 5 % other than believed and PSF weights took them out",
                     &TargetMetrics::neighbour_magnitude));
  c.push_back({"exposures", "", "exposures in which the star was measured",
               [](const TargetMetrics& t) { return Cell(t.exposures); }});
  c.push_back({"missing", "", "exposures in which it could not be measured",
               [](const TargetMetrics& t) { return Cell(t.missing); }});
  c.push_back({"bins", "", "bins of which at least half the exposures were measured",
               [](const TargetMetrics& t) { return Cell(t.bins); }});
  c.push_back({"flags", "", "names of the measurement flags, joined by |",
               [](const TargetMetrics& t) { return Cell(flag_text(t.flags)); }});
}

}  // namespace

std::span<const Column<TargetMetrics>> target_columns() {
  static const std::vector<TargetColumn> columns = [] {
    std::vector<TargetColumn> c;
    add_star(c);
    add_exposure_noise(c);
    add_hour_noise(c);
    add_causes(c);
    add_recovery(c);
    return c;
  }();
  return columns;
}

}  // namespace astroid
