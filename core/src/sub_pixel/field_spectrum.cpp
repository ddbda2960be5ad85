#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "astroid/core/psf_spectrum.hpp"
#include "field_weights.hpp"

namespace astroid {

namespace {

/// The largest sum of absolute weights on a grid over the places, where they are largest.
double amplification_of(const detail::FieldWeights& weights) {
  constexpr int kGrid = 64;
  PixelPosition lower = weights.nodes().front();
  PixelPosition upper = lower;
  for (const PixelPosition& p : weights.nodes()) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  }
  std::vector<double> at(weights.nodes().size());
  double largest = 1.0;
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      weights.at({lower.x + (upper.x - lower.x) * i / kGrid, lower.y + (upper.y - lower.y) * j / kGrid}, at);
      double sum = 0.0;
      for (const double w : at) sum += std::abs(w);
      largest = std::max(largest, sum);
    }
  return largest;
}

}  // namespace

FieldSpectrum make_field_spectrum(std::span<const FieldPsfTable> tables, Pixels diffusion) {
  detail::require_field(tables);
  std::vector<PixelPosition> nodes;
  FieldSpectrum field;
  for (const FieldPsfTable& table : tables) {
    nodes.push_back(table.position);
    field.members.push_back(make_table_spectrum(diffuse_psf_table(table.table, diffusion)));
  }
  const auto weights = std::make_shared<const detail::FieldWeights>(std::move(nodes));
  field.amplification = amplification_of(*weights);
  field.weights = [weights](PixelPosition place, std::span<double> values) { weights->at(place, values); };
  return field;
}

}  // namespace astroid
