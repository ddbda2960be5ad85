#include "astroid/photometry/residual_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace astroid {

Image<float, unit::Adu> residual_image(const Frame& frame, const BackgroundMap& background,
                                       std::span<const SourceMeasurement> sources, const PixelPsf& psf) {
  const auto pixels = frame.pixels.view(0);
  const Rectangle& area = pixels.area();
  Image<float, unit::Adu> residual(area);
  std::vector<double> level(static_cast<std::size_t>(area.nx));
  for (int y = area.y0; y < area.y1(); ++y) {
    background.level_row(y, level);
    const auto row = pixels.row(y);
    const auto out = residual.row(y);
    for (std::size_t x = 0; x < row.size(); ++x)
      out[x] = std::isfinite(row[x]) ? static_cast<float>(static_cast<double>(row[x]) - level[x])
                                     : std::numeric_limits<float>::quiet_NaN();
  }
  const double gain = frame.header.gain.value();
  // The wings of a bright star reach as far as a thousandth of the noise of a pixel.
  const double noise = std::max(1e-12, gain * background.median_rms());
  constexpr double kWing = 1e-3;
  constexpr double kLeastLost = 1e-7;
  constexpr double kMostLost = 1e-2;
  std::vector<double> fractions;
  for (const SourceMeasurement& source : sources) {
    if (!std::isfinite(source.flux) || !std::isfinite(source.x) || !std::isfinite(source.y)) continue;
    const double lost = std::clamp(kWing * noise / std::max(1e-300, std::abs(source.flux)), kLeastLost, kMostLost);
    const Rectangle box = intersect(stamp_box({source.x, source.y}, psf.stamp_half_width(lost)), area);
    if (box.size() == 0) continue;
    fractions.resize(box.size());
    psf.integrate({source.x, source.y}, box, fractions);
    std::size_t i = 0;
    for (int y = box.y0; y < box.y1(); ++y)
      for (int x = box.x0; x < box.x1(); ++x, ++i)
        residual.at(x, y) -= static_cast<float>(source.flux / gain * fractions[i]);
  }
  return residual;
}

}  // namespace astroid
