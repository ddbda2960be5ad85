#include "field/field_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "source_places.hpp"

namespace astroid::detail {

namespace {

constexpr double kQuantisation = 1.0 / 12.0;

}  // namespace

FieldPixels field_pixels(const Frame& frame, const MeshSettings& settings, int pad) {
  const BackgroundMap mesh(frame, 0, settings);
  const double gain = frame.header.gain.value();
  const double bias = frame.header.bias.value();
  const auto values = frame.pixels.view(0);
  const auto flags = frame.flags.view(0);
  const Rectangle& area = values.area();
  const PaddedPlane empty(area.nx, area.ny, pad);
  FieldPixels pixels{.electrons = empty, .usable = empty, .sky = empty};
  std::vector<double> level(static_cast<std::size_t>(area.nx));
  for (int j = 0; j < area.ny; ++j) {
    mesh.level_row(area.y0 + j, level);
    const auto row = values.row(area.y0 + j);
    const auto flag = flags.row(area.y0 + j);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double sky = gain * (level[i] - bias);
      pixels.sky.row(j)[i] = std::isfinite(sky) ? static_cast<float>(sky) : 0.0F;
      if (!may_be_fitted(flag[i], row[i])) continue;
      pixels.electrons.row(j)[i] = static_cast<float>(gain * (static_cast<double>(row[i]) - bias));
      pixels.usable.row(j)[i] = 1.0F;
      pixels.any = true;
    }
  }
  const double sky = std::max(0.0, gain * (mesh.median_level() - bias));
  const double readout = frame.header.readout_noise.value();
  const double stated = readout * readout + gain * gain * kQuantisation;
  const double measured = gain * gain * mesh.median_rms() * mesh.median_rms();
  // A sky that was subtracted before still has its noise. Crowding alone does not double what the header states.
  constexpr double kDoubtful = 2.0;
  pixels.read_variance = stated;
  if (measured > kDoubtful * (stated + sky) || readout == 0.0) pixels.read_variance = std::max(stated, measured - sky);
  return pixels;
}

}  // namespace astroid::detail
