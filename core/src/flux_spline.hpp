// The running integral of a PSF table as a tensor cubic spline: exact flux per sample, smooth in between.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "astroid/core/psf.hpp"

namespace astroid::detail {

/// Flux of a table in any rectangle, normalised to 1 over the whole table and zero outside.
///
/// C(u, v), the flux to the lower left of (u, v), is interpolated at the edges of the samples by natural cubic
/// B-splines in both axes; a rectangle's flux is its mixed difference. So every sample keeps its flux exactly and the
/// surface brightness is continuous inside the table.
class FluxSpline {
 public:
  /// @throws InputError naming everything that makes the table unusable.
  explicit FluxSpline(const PsfTable& table);

  /// Position of an edge, in samples, limited to the table, with the weights of the four coefficients around it.
  struct Edge {
    std::size_t first = 0;
    std::array<double, 4> weights{};
  };
  /// @param offset  px from the PSF's origin.
  [[nodiscard]] Edge x_edge(double offset) const { return edge(offset, centre_x_, nx_); }
  [[nodiscard]] Edge y_edge(double offset) const { return edge(offset, centre_y_, ny_); }

  /// C's coefficients combined along x at each of the edges.  @param rows  [out] shape (coefficient_rows(),
  /// edges.size())
  void at_edges(std::span<const Edge> edges, std::span<double> rows) const;
  /// C's coefficients combined along x to the flux between two edges, one number per coefficient row.
  void integrate_rows(const Edge& left, const Edge& right, std::span<double> rows) const;
  /// Those combined along y.
  [[nodiscard]] static double integrate_column(std::span<const double> rows, const Edge& bottom, const Edge& top);
  [[nodiscard]] std::size_t coefficient_rows() const { return ny_ + 3; }

  /// C's coefficients, coefficient_rows() rows of nx() + 3: B-splines centred on the edges -1 … nx() + 1 of the
  /// samples.
  [[nodiscard]] std::span<const double> coefficients() const { return coefficients_; }

  /// Flux in the rectangle [x0, x1] x [y0, y1], px from the PSF's origin.
  [[nodiscard]] double flux(PixelPosition lower, PixelPosition upper) const;

  /// Surface brightness, 1/px²: the mixed derivative of C; 0 beside the table.
  [[nodiscard]] double density(PixelPosition offset) const;

  /// Extent of the table, px from the PSF's origin.
  [[nodiscard]] PixelPosition lower() const;
  [[nodiscard]] PixelPosition upper() const;
  [[nodiscard]] double samples_per_pixel() const { return samples_per_pixel_; }
  [[nodiscard]] std::size_t nx() const { return nx_; }
  [[nodiscard]] std::size_t ny() const { return ny_; }

 private:
  [[nodiscard]] Edge edge(double offset, double centre, std::size_t samples) const;

  std::size_t nx_;
  std::size_t ny_;
  double samples_per_pixel_;
  double centre_x_;  // of the origin, from the outer edge of the first sample, in samples
  double centre_y_;
  std::vector<double> coefficients_;  // (ny + 3) rows of nx + 3
};

}  // namespace astroid::detail
