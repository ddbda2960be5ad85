// What smearing and the levels that calibration subtracts add to a flux and its noise.
#include <algorithm>

#include "star_estimator_builder.hpp"

namespace astroid::detail {

void StarEstimatorBuilder::smear_window(const Rectangle& window) {
  if (model_.smearing.electrons.empty()) return;
  std::size_t i = 0;
  for (int y = window.y0; y < window.y1(); ++y)
    for (int x = window.x0; x < window.x1(); ++x, ++i) total_[i] += model_.smearing.at(x);
}

void StarEstimatorBuilder::add_calibration_noise(StarEstimator& estimator) {
  const ColumnSmearing& smearing = model_.smearing;
  EstimatorBudget& budget = estimator.budget;
  if (smearing.electrons.empty() && smearing.overscan_rows <= 0 && model_.bias_variance <= 0.0) return;
  const Rectangle& region = layout_.regions()[estimator.region];
  const auto width = static_cast<std::size_t>(region.nx);
  const auto column_of = [&](const EstimatorTerm& term) {
    return (term.pixel - layout_.offset(estimator.region)) % width;
  };
  std::size_t first = width;
  std::size_t last = 0;
  for (const EstimatorTerm& term : estimator.terms) {
    first = std::min(first, column_of(term));
    last = std::max(last, column_of(term));
  }
  if (first > last) return;  // no terms
  const int first_column = region.x0 + static_cast<int>(first);
  column_weights_.assign(last - first + 1, 0.0);
  double weight_sum = 0.0;
  for (const EstimatorTerm& term : estimator.terms) {
    const std::size_t column = column_of(term) - first;
    const auto weight = static_cast<double>(term.weight);
    const double smeared = smearing.at(first_column + static_cast<int>(column));
    budget.var_smearing += weight * weight * smeared;
    budget.smearing += weight * smeared;
    column_weights_[column] += weight;
    weight_sum += weight;
  }
  if (smearing.overscan_rows <= 0) {
    budget.var_bias = weight_sum * weight_sum * model_.bias_variance;
    return;
  }
  // The level of a column is subtracted from all its pixels, so its error enters with their summed weight. It holds the
  // bias of the same exposure, so that an error of that cancels.
  budget.smearing = 0.0;
  const PixelNoise& noise = model_.noise;
  const double electronics = noise.readout * noise.readout + noise.quantisation * noise.quantisation;
  for (std::size_t column = 0; column < column_weights_.size(); ++column) {
    const double weight = column_weights_[column];
    if (weight == 0.0) continue;
    const double variance = smearing.at(first_column + static_cast<int>(column)) + electronics;
    budget.var_smearing_correction += weight * weight * variance / smearing.overscan_rows;
  }
}

}  // namespace astroid::detail
