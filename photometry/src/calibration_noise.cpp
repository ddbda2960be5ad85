// What smearing and the levels that calibration subtracts add to a flux and its noise.
#include <algorithm>
#include <numbers>

#include "astroid/core/math.hpp"
#include "star_estimator_builder.hpp"

namespace astroid::detail {

namespace {

bool differs_between_nodes(const GroundModel& model) {
  return std::any_of(model.more_readout_variance.begin(), model.more_readout_variance.end(),
                     [](double variance) { return variance != 0.0; });
}

/// Variance of the weighted sum of a wave of random phase. @source F104
double pick_up_variance(const GroundModel& model, const StarEstimator& estimator, const Rectangle& region,
                        std::size_t offset) {
  if (model.pick_up == 0.0) return 0.0;
  const auto width = static_cast<std::size_t>(region.nx);
  double sine = 0.0;
  double cosine = 0.0;
  for (const EstimatorTerm& term : estimator.terms) {
    const std::size_t k = term.pixel - offset;
    const double angle = 2.0 * std::numbers::pi *
                         (model.pick_up_column_frequency * (region.x0 + static_cast<int>(k % width)) +
                          model.pick_up_row_frequency * (region.y0 + static_cast<int>(k / width)));
    sine += static_cast<double>(term.weight) * det::sin(angle);
    cosine += static_cast<double>(term.weight) * det::cos(angle);
  }
  return 0.5 * model.pick_up * model.pick_up * (sine * sine + cosine * cosine);
}

}  // namespace

void StarEstimatorBuilder::smear_window(const Rectangle& window) {
  const bool unequal = differs_between_nodes(model_);
  if (model_.smearing.electrons.empty() && !unequal) return;
  std::size_t i = 0;
  for (int y = window.y0; y < window.y1(); ++y)
    for (int x = window.x0; x < window.x1(); ++x, ++i) {
      total_[i] += model_.smearing.at(x, y);
      if (unequal) total_[i] += model_.more_readout_variance[static_cast<std::size_t>(model_.nodes.of(x, y))];
    }
}

void StarEstimatorBuilder::add_calibration_noise(StarEstimator& estimator) {
  const ColumnSmearing& smearing = model_.smearing;
  EstimatorBudget& budget = estimator.budget;
  const Rectangle& region = layout_.regions()[estimator.region];
  const auto width = static_cast<std::size_t>(region.nx);
  const bool unequal = differs_between_nodes(model_);
  std::size_t left = width;
  std::size_t bottom = static_cast<std::size_t>(region.ny);
  std::size_t right = 0;
  std::size_t top = 0;
  for (const EstimatorTerm& term : estimator.terms) {
    const std::size_t k = term.pixel - layout_.offset(estimator.region);
    left = std::min(left, k % width);
    right = std::max(right, k % width);
    bottom = std::min(bottom, k / width);
    top = std::max(top, k / width);
  }
  if (left > right) return;  // no terms
  // Of the columns below `upper_row`, then of those above: their levels are measured apart.
  const std::size_t columns = right - left + 1;
  column_weights_.assign(2 * columns, 0.0);
  row_weights_.assign(top - bottom + 1, 0.0);
  for (const EstimatorTerm& term : estimator.terms) {
    const std::size_t k = term.pixel - layout_.offset(estimator.region);
    const auto weight = static_cast<double>(term.weight);
    const int x = region.x0 + static_cast<int>(k % width);
    const int y = region.y0 + static_cast<int>(k / width);
    const double smeared = smearing.at(x, y);
    budget.var_smearing += weight * weight * smeared;
    budget.smearing += weight * smeared;
    budget.bias_weight += weight;
    column_weights_[k % width - left + (smearing.is_upper(y) ? columns : 0)] += weight;
    row_weights_[k / width - bottom] += weight;
    if (unequal)
      budget.var_readout +=
          weight * weight * model_.more_readout_variance[static_cast<std::size_t>(model_.nodes.of(x, y))];
  }
  const double common = budget.bias_weight * budget.bias_weight;  // of what all pixels share
  for (const double weight : row_weights_) budget.var_bias += weight * weight * model_.row_offset_variance;
  budget.var_bias += pick_up_variance(model_, estimator, region, layout_.offset(estimator.region));
  if (smearing.overscan_rows <= 0) {
    budget.var_bias += common * model_.bias_variance;
    if (model_.bias_is_measured) budget.bias_weight = 0.0;
    return;
  }
  // The level of a column is subtracted from all its pixels, so its error enters with their summed weight. It holds the
  // bias of the same exposure, so that an error of that cancels.
  budget.smearing = 0.0;
  budget.bias_weight = 0.0;
  budget.var_bias += common * model_.row_offset_variance / smearing.overscan_rows;
  const PixelNoise& noise = noise_;
  const double electronics = noise.readout * noise.readout + noise.quantisation * noise.quantisation;
  for (std::size_t column = 0; column < column_weights_.size(); ++column) {
    const double weight = column_weights_[column];
    if (weight == 0.0) continue;
    const int x = region.x0 + static_cast<int>(left + column % columns);
    const int y = column < columns ? region.y0 : std::max(region.y0, smearing.upper_row);  // of that half
    double variance = smearing.at(x, y) + electronics;
    if (unequal) variance += model_.more_readout_variance[static_cast<std::size_t>(model_.nodes.of(x, y))];
    budget.var_smearing_correction += weight * weight * variance / smearing.overscan_rows;
  }
}

}  // namespace astroid::detail
