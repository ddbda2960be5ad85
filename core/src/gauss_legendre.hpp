// Composite Gauss-Legendre quadrature on an interval.
#pragma once

#include <vector>

namespace astroid::detail {

struct QuadratureNode {
  double place, weight;
};

/// Points and weights of 24-point rules on equal panels of [from, to], none wider than `panel`.
/// @accuracy  1e-15 for what oscillates by up to 6 turns a panel, or has its poles no nearer to it than half of it
std::vector<QuadratureNode> gauss_legendre(double from, double to, double panel);

}  // namespace astroid::detail
