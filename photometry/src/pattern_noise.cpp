// Readout noise that the pixels of a column or of a row share: it does not average down within an aperture.
#include <cmath>
#include <cstddef>
#include <map>

#include "star_estimator_builder.hpp"

namespace astroid::detail {

void StarEstimatorBuilder::add_pattern_noise(const Rectangle& window, StarEstimator& estimator) {
  const PixelNoise& noise = model_.noise;
  if (noise.column <= 0.0 && noise.row <= 0.0) return;
  const Rectangle& region = layout_.regions()[estimator.region];
  const auto width = static_cast<std::size_t>(region.nx);
  // Background pixels have negative weights: what they share with the aperture cancels in part.
  std::map<int, double> columns;
  std::map<int, double> rows;
  for (const EstimatorTerm& term : estimator.terms) {
    const std::size_t k = term.pixel - layout_.offset(estimator.region);
    const int x = region.x0 + static_cast<int>(k % width);
    const int y = region.y0 + static_cast<int>(k / width);
    double light = 0.0;
    if (window.contains(x, y))
      light = total_[static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.nx) +
                     static_cast<std::size_t>(x - window.x0)];
    // Weights of reads differ between bright and dark pixels; taking them as alike states rather too much.
    const double weight = static_cast<double>(term.weight) * std::sqrt(noise.factors(light).readout);
    columns[x] += weight;
    rows[y] += weight;
  }
  double column_squares = 0.0;
  double row_squares = 0.0;
  for (const auto& [x, weight] : columns) column_squares += weight * weight;
  for (const auto& [y, weight] : rows) row_squares += weight * weight;
  estimator.budget.var_readout += column_squares * noise.column * noise.column + row_squares * noise.row * noise.row;
}

}  // namespace astroid::detail
