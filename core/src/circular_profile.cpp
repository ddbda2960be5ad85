#include "circular_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace astroid::detail {

namespace {

struct Node {
  double place, weight;  // on [-1, 1]
};

// Gauss-Legendre rules of 3, 4, 5 and 7 points.  @source AbramowitzStegun1964 Table 25.4
constexpr std::array<Node, 3> kThree = {{{-0.774596669241483377036, 0.555555555555555555556},
                                         {0.0, 0.888888888888888888889},
                                         {0.774596669241483377036, 0.555555555555555555556}}};
constexpr std::array<Node, 4> kFour = {{{-0.861136311594052575224, 0.347854845137453857373},
                                        {-0.339981043584856264803, 0.652145154862546142627},
                                        {0.339981043584856264803, 0.652145154862546142627},
                                        {0.861136311594052575224, 0.347854845137453857373}}};
constexpr std::array<Node, 5> kFive = {{{-0.906179845938663992798, 0.236926885056189087514},
                                        {-0.538469310105683091036, 0.478628670499366468041},
                                        {0.0, 0.568888888888888888889},
                                        {0.538469310105683091036, 0.478628670499366468041},
                                        {0.906179845938663992798, 0.236926885056189087514}}};
constexpr std::array<Node, 7> kSeven = {{{-0.949107912342758524526, 0.129484966168869693271},
                                         {-0.741531185599394439864, 0.279705391489276667901},
                                         {-0.405845151377397166907, 0.381830050505118944950},
                                         {0.0, 0.417959183673469387755},
                                         {0.405845151377397166907, 0.381830050505118944950},
                                         {0.741531185599394439864, 0.279705391489276667901},
                                         {0.949107912342758524526, 0.129484966168869693271}}};

// Points that give 1e-11 for a profile that changes over `scale`.
std::span<const Node> rule(double cell, double scale) {
  constexpr double kForThree = 1.0 / 40.0;
  constexpr double kForFour = 1.0 / 20.0;
  constexpr double kForFive = 1.0 / 10.0;
  const double ratio = cell / scale;
  if (ratio <= kForThree) return kThree;
  if (ratio <= kForFour) return kFour;
  if (ratio <= kForFive) return kFive;
  return kSeven;
}

}  // namespace

PsfTable flux_table(const CircularProfile& profile, int samples_per_pixel, int half_width) {
  const int half = samples_per_pixel * half_width;
  const double cell = 1.0 / samples_per_pixel;
  constexpr double kWidestCell = 0.25;  // of the scale, for seven points
  const int parts = std::max(1, static_cast<int>(std::ceil(cell / (kWidestCell * profile.scale))));
  const std::span<const Node> nodes = rule(cell / parts, profile.scale);
  // Squared distances along one axis of all quadrature points of the positive half, and their weights.
  struct Point {
    double square, weight;
  };
  std::vector<Point> points;
  const double part = cell / parts;
  for (int i = 0; i < half; ++i) {
    for (int k = 0; k < parts; ++k) {
      for (const Node& node : nodes) {
        const double x = i * cell + (k + 0.5 + 0.5 * node.place) * part;
        points.push_back({x * x, 0.5 * part * node.weight});
      }
    }
  }
  const auto per_cell = static_cast<std::size_t>(parts) * nodes.size();
  PsfTable table;
  table.samples = Image<double, unit::Relative>(2 * half, 2 * half);
  table.samples_per_pixel = samples_per_pixel;
  table.centre_x = table.centre_y = half - 0.5;
  for (int j = 0; j < half; ++j) {
    const auto column = std::span(points).subspan(static_cast<std::size_t>(j) * per_cell, per_cell);
    for (int i = 0; i <= j; ++i) {
      const auto row = std::span(points).subspan(static_cast<std::size_t>(i) * per_cell, per_cell);
      double sum = 0.0;
      for (const Point& y : column) {
        double line = 0.0;
        for (const Point& x : row) line += x.weight * profile.density(x.square + y.square);
        sum += y.weight * line;
      }
      // The eight places that symmetry makes alike.
      for (const auto& [u, v] : {std::pair{i, j}, std::pair{j, i}}) {
        table.samples.at(half + u, half + v) = sum;
        table.samples.at(half - 1 - u, half + v) = sum;
        table.samples.at(half + u, half - 1 - v) = sum;
        table.samples.at(half - 1 - u, half - 1 - v) = sum;
      }
    }
  }
  return table;
}

}  // namespace astroid::detail
