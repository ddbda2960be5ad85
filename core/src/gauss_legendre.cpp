#include "gauss_legendre.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

namespace astroid::detail {

namespace {

constexpr std::size_t kPoints = 24;

std::array<QuadratureNode, kPoints> make_rule() {
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(kPoints), &gsl_integration_glfixed_table_free);
  std::array<QuadratureNode, kPoints> rule{};
  for (std::size_t i = 0; i < kPoints; ++i)
    gsl_integration_glfixed_point(-1.0, 1.0, i, &rule[i].place, &rule[i].weight, table.get());
  return rule;
}

}  // namespace

std::vector<QuadratureNode> gauss_legendre(double from, double to, double panel) {
  static const std::array<QuadratureNode, kPoints> rule = make_rule();
  std::vector<QuadratureNode> nodes;
  if (!(to > from)) return nodes;
  const int panels = std::max(1, static_cast<int>(std::ceil((to - from) / panel)));
  const double half = 0.5 * (to - from) / panels;
  for (int k = 0; k < panels; ++k)
    for (const QuadratureNode& node : rule)
      nodes.push_back({from + (2 * k + 1 + node.place) * half, node.weight * half});
  return nodes;
}

}  // namespace astroid::detail
