// How a star between the nodes of a grid is spread over them, so that in Fourier space it is a pure phase ramp.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace astroid::detail {

/// The Kaiser-Bessel kernel of a non-uniform Fourier transform, and its own transform, by which it is divided out.
///
/// A star at x nodes leaves phi(m - x) on node m; the spectrum of the nodes, divided by transform(f), is that of a
/// point at x: e^(-2 pi i f x) for every |f| up to `band`.
/// @accuracy  of the star: 1e-14 in the inner half of the band, 1e-12 at its edge, where a PSF leaves little
///            (test: DepositKernel.MakesAStarAPurePhaseRamp), for any x: nothing is snapped.
/// @source Beatty2005 Eq. 5 for the shape; Barnett2019 for the error, e^(-pi width sqrt(1 - 2 band)).
class DepositKernel {
 public:
  static constexpr std::size_t kWidest = 28;
  /// @param band  highest frequency wanted, cycles per node, at most 0.42.
  explicit DepositKernel(double band);

  /// Nodes that a star touches, and what it leaves on each.
  struct Nodes {
    long first = 0;
    std::array<double, kWidest> weights{};
  };
  [[nodiscard]] Nodes nodes(double x) const;
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Integral of phi(x) e^(-2 pi i f x), f in cycles per node.
  [[nodiscard]] double transform(double frequency) const;

 private:
  std::size_t width_;
  double shape_;
  std::vector<double> series_;  // of I0(shape sqrt(u)) / I0(shape) in powers of u
  double centre_;               // I0(shape)
};

}  // namespace astroid::detail
