#include "astroid/test/sub_pixel_psf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace astroid::test {

namespace {

class SubPixelPsf final : public PixelPsf {
 public:
  SubPixelPsf(std::shared_ptr<const PsfSpectrum> spectrum, int reach, const SubPixelSettings& settings)
      : spectrum_(std::move(spectrum)),
        detector_{-reach, -reach, 2 * reach + 1, 2 * reach + 1},
        renderer_(spectrum_, detector_, settings) {}

  void integrate(PixelPosition centre, Rectangle box, std::span<double> fractions) const override {
    std::ranges::fill(fractions, 0.0);
    const double x = std::floor(centre.x);
    const double y = std::floor(centre.y);
    const StarLight star{.centre = {centre.x - x, centre.y - y}, .electrons = 1.0};
    const Rectangle wanted{box.x0 - static_cast<int>(x), box.y0 - static_cast<int>(y), box.nx, box.ny};
    SubPixelRenderer::Workspace workspace;
    for (const Rectangle& tile : renderer_.tiles()) {
      const Rectangle common = intersect(tile, wanted);
      if (common.empty()) continue;
      std::vector<double> light(tile.size());
      renderer_.render(tile, {&star, 1}, workspace, light);
      for (int row = common.y0; row < common.y1(); ++row)
        for (int column = common.x0; column < common.x1(); ++column)
          fractions[static_cast<std::size_t>((row - wanted.y0) * wanted.nx + column - wanted.x0)] =
              light[static_cast<std::size_t>((row - tile.y0) * tile.nx + column - tile.x0)];
    }
  }

  void integrate_gradient(PixelPosition /*centre*/, Rectangle /*box*/, std::span<double> dpdx,
                          std::span<double> dpdy) const override {
    std::ranges::fill(dpdx, std::numeric_limits<double>::quiet_NaN());
    std::ranges::fill(dpdy, std::numeric_limits<double>::quiet_NaN());
  }

  [[nodiscard]] double stamp_half_width(double lost) const override { return spectrum_->reach(lost); }
  [[nodiscard]] double approximation_error() const override { return renderer_.predicted_error(); }
  [[nodiscard]] std::string description() const override { return renderer_.description(); }

 private:
  std::shared_ptr<const PsfSpectrum> spectrum_;
  Rectangle detector_;
  SubPixelRenderer renderer_;
};

}  // namespace

std::shared_ptr<const PixelPsf> make_sub_pixel_psf(std::shared_ptr<const PsfSpectrum> spectrum, int reach,
                                                   const SubPixelSettings& settings) {
  return std::make_shared<const SubPixelPsf>(std::move(spectrum), reach, settings);
}

std::vector<double> light_by_cells(const SubPixelRenderer& renderer, const PixelResponse& response, PixelPosition star,
                                   Rectangle box) {
  const StarLight light{.centre = star, .electrons = 1.0};
  SubPixelRenderer::Workspace workspace;
  std::vector<double> p(box.size());
  const int n = response.cells;
  for (const Rectangle& tile : renderer.tiles()) {
    std::vector<double> cells(tile.size() * static_cast<std::size_t>(n * n));
    renderer.render_cells(tile, {&light, 1}, workspace, cells);
    for (int y = 0; y < tile.ny * n; ++y)
      for (int x = 0; x < tile.nx * n; ++x)
        p[static_cast<std::size_t>((tile.y0 - box.y0 + y / n) * box.nx + tile.x0 - box.x0 + x / n)] +=
            response.at(x % n, y % n) * cells[static_cast<std::size_t>(y * tile.nx * n + x)];
  }
  return p;
}

}  // namespace astroid::test
