// One star of a field together with the stars around it: what its flux can be told to, and whether one more is there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/field_solver.hpp"

namespace astroid::detail {

/// A flux and its standard deviation when all stars around are free.
struct FluxEstimate {
  double flux = 0.0;
  double error = 0.0;  ///< infinity when it cannot be told from its neighbours
};

/// The covariance of one star's parameters, its neighbours' unknown.
struct StarCovariance {
  std::array<double, 6> covariance{};  ///< FF, Fx, Fy, xx, xy, yy
  double share = 1.0;                  ///< of the information about its flux that neighbours leave, 0 … 1
  bool degenerate = false;             ///< nothing of its flux can be told from the others
};

/// Normal equations of a few stars, cut out of those of a field. Scratch space is kept: one object per thread.
class LocalFit {
 public:
  explicit LocalFit(const FieldSolver& field) : field_(field) {}

  /// Most stars that are free at a time beside the one asked for: the nearest ones.
  static constexpr std::size_t kMostNeighbours = 8;

  [[nodiscard]] StarCovariance covariance(std::size_t star);
  /// The flux that a further star at (x, y) would get, to first order, with all around it free.
  [[nodiscard]] FluxEstimate candidate(double x, double y);
  /// Distance of the nearest star at the last call of candidate(), px.
  [[nodiscard]] double nearest() const { return nearest_; }

 private:
  void gather(double x, double y, std::size_t without);
  void fill_neighbours(std::size_t n);

  const FieldSolver& field_;
  double nearest_ = 0.0;
  std::vector<std::uint32_t> near_;
  std::vector<double> matrix_;
  std::vector<double> right_;
  std::vector<double> fractions_;
  std::vector<float> stamp_;
  std::vector<float> weighted_;
};

}  // namespace astroid::detail
