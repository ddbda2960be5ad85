#include "bilinear_light.hpp"

namespace astroid {

BilinearLight::BilinearLight(const Rectangle& detector, const std::array<double, 4>& corners) {
  // u = (x - x0 + 1/2) / nx and v alike run from 0 to 1; the products are sorted by powers of x and y.
  const double u = 1.0 / detector.nx;
  const double v = 1.0 / detector.ny;
  const double u0 = (0.5 - detector.x0) * u;
  const double v0 = (0.5 - detector.y0) * v;
  const double along_x = corners[1] - corners[0];
  const double along_y = corners[2] - corners[0];
  const double twist = corners[3] - corners[2] - along_x;
  constant_ = corners[0] + along_x * u0 + along_y * v0 + twist * u0 * v0;
  x_ = u * (along_x + twist * v0);
  y_ = v * (along_y + twist * u0);
  xy_ = twist * u * v;
}

void add_light(const BilinearLight& light, const Strip& strip, StripPlane<double, unit::ExpectedElectrons>& expected) {
  for (std::size_t a = 0; a < strip.areas.size(); ++a) {
    const auto view = expected.view(strip, a);
    const Rectangle& area = strip.areas[a];
    for (int y = area.y0; y < area.y1(); ++y) {
      const auto [first, slope] = light.row(y);
      double x = area.x0;
      for (double& value : view.row(y)) {
        value += first + slope * x;
        x += 1.0;
      }
    }
  }
}

}  // namespace astroid
