// Noise that pixels have in common: photon noise of coupled neighbours, readout noise of a column or a row.
#include <cmath>
#include <cstddef>
#include <map>

#include "star_estimator_builder.hpp"

namespace astroid::detail {

const std::vector<double>& StarEstimatorBuilder::couple_weights(const Rectangle& window) {
  const double side = model_.noise.side_coupling;
  const double corner = model_.noise.corner_coupling;
  if (side <= 0.0 && corner <= 0.0) return weights_;
  coupled_weights_.assign(weights_.size(), 0.0);
  const double own = 1.0 - 4.0 * (side + corner);
  const auto weight = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= window.nx || y >= window.ny) return 0.0;
    return weights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(window.nx) + static_cast<std::size_t>(x)];
  };
  std::size_t i = 0;
  for (int y = 0; y < window.ny; ++y) {
    for (int x = 0; x < window.nx; ++x, ++i) {
      const double sides = weight(x - 1, y) + weight(x + 1, y) + weight(x, y - 1) + weight(x, y + 1);
      const double corners = weight(x - 1, y - 1) + weight(x + 1, y - 1) + weight(x - 1, y + 1) + weight(x + 1, y + 1);
      coupled_weights_[i] = own * weight(x, y) + side * sides + corner * corners;
    }
  }
  return coupled_weights_;
}

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
