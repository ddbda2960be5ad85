// A PSF spread by inter-pixel capacitance.
#include "astroid/core/inter_pixel_coupling.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace astroid {
namespace {

TEST(CoupledPsf, KeepsTheFluxAndSpreadsThePixels) {
  const auto psf = make_gaussian_psf(0.6);
  const InterPixelCoupling coupling{.side = 0.02, .corner = 0.003};
  const auto coupled = make_coupled_psf(psf, coupling);
  const Rectangle box{-12, -12, 25, 25};
  std::vector<double> plain(box.size());
  std::vector<double> spread(box.size());
  psf->integrate({0.2, -0.3}, box, plain);
  coupled->integrate({0.2, -0.3}, box, spread);
  EXPECT_NEAR(std::accumulate(spread.begin(), spread.end(), 0.0), 1.0, 1e-12);
  const auto at = [&](const std::vector<double>& v, int x, int y) {
    return v[static_cast<std::size_t>((y - box.y0) * box.nx + x - box.x0)];
  };
  double expected = coupling.own() * at(plain, 0, 0);
  for (const auto& [x, y] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}})
    expected += coupling.side * at(plain, x, y);
  for (const auto& [x, y] : {std::pair{1, 1}, std::pair{-1, 1}, std::pair{1, -1}, std::pair{-1, -1}})
    expected += coupling.corner * at(plain, x, y);
  EXPECT_NEAR(at(spread, 0, 0), expected, 1e-15);
  // A pixel is the same in any box.
  double alone = 0.0;
  coupled->integrate({0.2, -0.3}, {1, 2, 1, 1}, {&alone, 1});
  EXPECT_EQ(alone, at(spread, 1, 2));
}

TEST(CoupledPsf, HasTheGradientOfItsFractions) {
  const auto coupled = make_coupled_psf(make_gaussian_psf(0.7), {.side = 0.01, .corner = 0.002});
  const Rectangle box{-2, -2, 5, 5};
  std::vector<double> dx(box.size());
  std::vector<double> dy(box.size());
  std::vector<double> plus(box.size());
  std::vector<double> minus(box.size());
  coupled->integrate_gradient({0.1, 0.2}, box, dx, dy);
  constexpr double kStep = 1e-5;
  coupled->integrate({0.1 + kStep, 0.2}, box, plus);
  coupled->integrate({0.1 - kStep, 0.2}, box, minus);
  for (std::size_t i = 0; i < box.size(); ++i) EXPECT_NEAR(dx[i], (plus[i] - minus[i]) / (2.0 * kStep), 1e-9);
  coupled->integrate({0.1, 0.2 + kStep}, box, plus);
  coupled->integrate({0.1, 0.2 - kStep}, box, minus);
  for (std::size_t i = 0; i < box.size(); ++i) EXPECT_NEAR(dy[i], (plus[i] - minus[i]) / (2.0 * kStep), 1e-9);
}

}  // namespace
}  // namespace astroid
