#include "astroid/reports/tables.hpp"

namespace astroid {

namespace {

template <class Row>
Column<Row> number(std::string name, std::string unit, std::string meaning, double Row::*member) {
  return {std::move(name), std::move(unit), std::move(meaning), [member](const Row& r) { return Cell(r.*member); }};
}

template <class Row>
Column<Row> count(std::string name, std::string meaning, std::int64_t Row::*member) {
  return {std::move(name), "", std::move(meaning), [member](const Row& r) { return Cell(r.*member); }};
}

/// The columns of a split of noise by cause; `what` says of what.
template <class Row>
void add_causes(std::vector<Column<Row>>& columns, const std::string& what) {
  struct Part {
    const char* name;
    const char* meaning;
    double NoiseByCause::*member;
  };
  const Part parts[] = {
      {"photon_ppm", "photon noise of the target", &NoiseByCause::photon},
      {"contaminants_ppm", "photon noise of all other stars", &NoiseByCause::contaminants},
      {"background_ppm", "photon noise of sky and dark current", &NoiseByCause::background},
      {"readout_ppm", "readout noise", &NoiseByCause::readout},
      {"quantisation_ppm", "rounding by the ADC", &NoiseByCause::quantisation},
      {"background_estimate_ppm", "noise of the local background that is subtracted",
       &NoiseByCause::background_estimate},
      {"jitter_ppm", "pointing jitter across the edge of the aperture, common to all cameras", &NoiseByCause::jitter},
      {"prnu_jitter_ppm", "pointing jitter over unequal pixels", &NoiseByCause::prnu_jitter},
      {"smearing_ppm", "photon noise of what is smeared along the columns, and noise of its correction",
       &NoiseByCause::smearing},
      {"bias_ppm", "noise of a measured bias, and offsets of rows", &NoiseByCause::bias},
      {"drift_ppm", "slow changes of gain and bias, common to all cameras", &NoiseByCause::drift},
  };
  for (const Part& part : parts) {
    columns.push_back({part.name, "ppm", what + part.meaning,
                       [member = part.member](const Row& r) { return Cell(r.causes.*member); }});
  }
}

Column<NoiseBin> ratio(std::string name, std::string meaning, MedianEstimate NoiseBin::*which,
                       double MedianEstimate::*part) {
  return {std::move(name), "", std::move(meaning), [which, part](const NoiseBin& r) { return Cell((r.*which).*part); }};
}

Column<RecoveryBin> estimate(std::string name, std::string unit, std::string meaning, MeanEstimate RecoveryBin::*which,
                             double MeanEstimate::*part) {
  return {std::move(name), std::move(unit), std::move(meaning),
          [which, part](const RecoveryBin& r) { return Cell((r.*which).*part); }};
}

}  // namespace

std::span<const Column<NoiseBin>> noise_columns() {
  static const std::vector<Column<NoiseBin>> columns = [] {
    std::vector<Column<NoiseBin>> c;
    c.push_back(number("mag_low", "mag", "bright edge of the bin, included", &NoiseBin::mag_low));
    c.push_back(number("mag_high", "mag", "faint edge of the bin, excluded", &NoiseBin::mag_high));
    c.push_back(number("mag_median", "mag", "median magnitude of its stars", &NoiseBin::mag_median));
    c.push_back(count("stars", "stars that are not saturated, cut, defective or without flux", &NoiseBin::stars));
    c.push_back(number("predicted_ppm", "ppm", "median of the predicted noise of one bin in time with all cameras",
                       &NoiseBin::predicted_ppm));
    c.push_back(number("measured_ppm", "ppm",
                       "median of the measured noise: std of bin means / c4, scaled to all cameras",
                       &NoiseBin::measured_ppm));
    c.push_back(number("measured_within_ppm", "ppm", "median of the noise measured within bins, scaled to all cameras",
                       &NoiseBin::measured_within_ppm));
    c.push_back(ratio(
        "ratio", "median of measured / predicted by bin means, with the simulated cameras, free of the median's bias",
        &NoiseBin::ratio, &MedianEstimate::value));
    c.push_back(ratio("ratio_low", "lower end of its 95 % interval (order statistics)", &NoiseBin::ratio,
                      &MedianEstimate::low));
    c.push_back(ratio("ratio_high", "upper end of its 95 % interval (order statistics)", &NoiseBin::ratio,
                      &MedianEstimate::high));
    c.push_back(ratio("ratio_within", "median of measured / predicted within bins", &NoiseBin::ratio_within,
                      &MedianEstimate::value));
    c.push_back(ratio("ratio_within_low", "lower end of its 95 % interval (order statistics)", &NoiseBin::ratio_within,
                      &MedianEstimate::low));
    c.push_back(ratio("ratio_within_high", "upper end of its 95 % interval (order statistics)", &NoiseBin::ratio_within,
                      &MedianEstimate::high));
    add_causes(c, "median of the predicted part: ");
    return c;
  }();
  return columns;
}

std::span<const Column<RecoveryBin>> recovery_columns() {
  static const std::vector<Column<RecoveryBin>> columns = [] {
    using E = MeanEstimate;
    std::vector<Column<RecoveryBin>> c;
    c.push_back(number("mag_low", "mag", "bright edge of the bin, included", &RecoveryBin::mag_low));
    c.push_back(number("mag_high", "mag", "faint edge of the bin, excluded", &RecoveryBin::mag_high));
    c.push_back(count("stars", "stars that were measured", &RecoveryBin::stars));
    c.push_back(count("not_positive", "of them with a flux that is not positive, so without a magnitude",
                      &RecoveryBin::not_positive));
    c.push_back(count("saturated", "of them saturated", &RecoveryBin::saturated));
    c.push_back(count("clean", "of them not saturated, cut, defective or without flux", &RecoveryBin::clean));
    c.push_back(count("uncontaminated", "clean stars with less contamination than Analysis/UncontaminatedSPR",
                      &RecoveryBin::uncontaminated));
    c.push_back(number("delta_median", "mag", "median of measured - true magnitude of clean stars",
                       &RecoveryBin::delta_median));
    c.push_back(number("contamination_median", "mag", "median of its part that neighbours cause",
                       &RecoveryBin::contamination_median));
    c.push_back(number("aperture_loss_median", "mag", "median of its part that light outside the aperture causes",
                       &RecoveryBin::aperture_loss_median));
    c.push_back(number("residual_median", "mag", "median of what is left", &RecoveryBin::residual_median));
    c.push_back(
        estimate("bias", "mag", "mean of what is left, uncontaminated stars", &RecoveryBin::residual, &E::value));
    c.push_back(estimate("bias_err", "mag", "its standard error", &RecoveryBin::residual, &E::error));
    c.push_back(estimate("scatter", "mag", "standard deviation of what is left from star to star",
                         &RecoveryBin::residual, &E::scatter));
    c.push_back(number("expected_scatter", "mag",
                       "rms of the expected errors: noise of the mean flux and fixed unequal pixels",
                       &RecoveryBin::expected_scatter));
    c.push_back(number("pull_width", "", "rms of (measured - expected flux) / expected error; 1 for honest errors",
                       &RecoveryBin::pull_width));
    c.push_back(
        estimate("flux_bias", "",
                 "mean of flux_measured / flux_expected - 1, uncontaminated stars; free of the logarithm's bias",
                 &RecoveryBin::flux_bias, &E::value));
    c.push_back(estimate("flux_bias_err", "", "its standard error", &RecoveryBin::flux_bias, &E::error));
    return c;
  }();
  return columns;
}

std::span<const Column<ContaminationRow>> contamination_columns() {
  static const std::vector<Column<ContaminationRow>> columns = [] {
    std::vector<Column<ContaminationRow>> c;
    c.push_back({"id", "", "the target's identifier", [](const ContaminationRow& r) { return Cell(r.id); }});
    c.push_back(number("mag", "mag", "true magnitude of the target", &ContaminationRow::mag));
    c.push_back(number("spr_tot", "", "neighbours' share of all star light in the aperture, sky excluded",
                       &ContaminationRow::spr_tot));
    c.push_back(number("delta_mag", "mag", "how much brighter the aperture looks, 2.5 log10(1 - spr_tot)",
                       &ContaminationRow::delta_mag));
    for (std::size_t k = 0; k < kListedContaminants; ++k) {
      const std::string prefix = "contaminant" + std::to_string(k + 1) + "_";
      const std::string which = "contaminant number " + std::to_string(k + 1) + " by its share: ";
      const auto has = [k](const ContaminationRow& r) { return r.strongest.size() > k; };
      c.push_back({prefix + "id", "", which + "its identifier; empty when there are fewer",
                   [k, has](const ContaminationRow& r) { return Cell(has(r) ? r.strongest[k].id : std::string()); }});
      const auto value = [&](const char* name, const char* unit, const char* meaning, double Contaminant::*member) {
        c.push_back({prefix + name, unit, which + meaning, [k, has, member](const ContaminationRow& r) {
                       return Cell(has(r) ? r.strongest[k].*member : std::numeric_limits<double>::quiet_NaN());
                     }});
      };
      value("dx", "px", "columns from the target", &Contaminant::dx);
      value("dy", "px", "rows from the target", &Contaminant::dy);
      value("electrons", "e-", "electrons per exposure, all of its PSF", &Contaminant::electrons);
      value("spr", "", "its share of all star light in the target's aperture, SPR_k", &Contaminant::spr);
    }
    return c;
  }();
  return columns;
}

std::span<const Column<BudgetRow>> budget_columns() {
  static const std::vector<Column<BudgetRow>> columns = [] {
    std::vector<Column<BudgetRow>> c;
    c.push_back(number("mag", "mag", "magnitude in the passband of the zero point, of a star at the centre of a pixel",
                       &BudgetRow::mag));
    c.push_back(number("electrons", "e-", "electrons per exposure, all of the PSF", &BudgetRow::electrons));
    c.push_back(number("peak_electrons", "e-", "of them in the brightest pixel", &BudgetRow::peak_electrons));
    c.push_back({"saturated", "",
                 "1 if the brightest pixel is above full well or the ADC's range: the rest does not hold",
                 [](const BudgetRow& r) { return Cell(std::int64_t{r.saturated ? 1 : 0}); }});
    c.push_back({"mask_pixels", "px", "pixels of the aperture",
                 [](const BudgetRow& r) { return Cell(std::int64_t{r.mask_pixels}); }});
    c.push_back(
        number("enclosed_fraction", "", "share of the flux that the aperture collects", &BudgetRow::enclosed_fraction));
    c.push_back(number("nsr_exposure", "", "noise-to-signal ratio of one exposure of one camera without jitter",
                       &BudgetRow::nsr_exposure));
    c.push_back(number("nsr_1h_ppm", "ppm",
                       "noise of the mean over one bin (Analysis/Bin, 1 h unless set) with all cameras",
                       &BudgetRow::nsr_1h_ppm));
    add_causes(c, "part of nsr_1h_ppm: ");
    c.push_back(
        number("spr_tot", "", "share of the given neighbours in the star light of the aperture", &BudgetRow::spr_tot));
    return c;
  }();
  return columns;
}

}  // namespace astroid
