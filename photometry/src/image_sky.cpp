#include "image_sky.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

ImageSky::ImageSky(const Frame& frame, const ImagePhotometrySettings& settings)
    : frame_(frame), settings_(settings), mesh_(settings.map) {}

const BackgroundMap& ImageSky::mesh() {
  if (!mesh_) mesh_ = std::make_shared<const BackgroundMap>(frame_, 0, settings_.mesh);
  return *mesh_;
}

const ImageSky::Row& ImageSky::row(int y) {
  const Rectangle& area = mesh().area();
  rows_.resize(static_cast<std::size_t>(area.ny));
  Row& row = rows_[static_cast<std::size_t>(y - area.y0)];
  if (row.level.empty()) {
    row.level.resize(static_cast<std::size_t>(area.nx));
    row.rms.resize(row.level.size());
    mesh().level_row(y, row.level);
    mesh().rms_row(y, row.rms);
  }
  return row;
}

SkyUnderStar ImageSky::from_rms(double level, double error, double rms) const {
  const double readout = frame_.header.readout_noise.value();
  const double gain = frame_.header.gain.value();
  // A noise-free picture still was read out.
  return {level, error, std::max(gain * gain * rms * rms, readout * readout), false};
}

SkyUnderStar ImageSky::under(PixelPosition star) {
  const Rectangle& area = frame_.pixels.layout().regions()[0];
  switch (settings_.background) {
    case BackgroundMethod::kKnown: {
      const FrameHeader& header = frame_.header;
      const double gain = header.gain.value();
      const double level = settings_.known_background.value();
      const double photons = std::max(0.0, gain * (level - header.bias.value()));
      constexpr double kUniformVariance = 1.0 / 12.0;  // of rounding to a whole number
      return {level, 0.0,
              photons + header.readout_noise.value() * header.readout_noise.value() + gain * gain * kUniformVariance,
              false};
    }
    case BackgroundMethod::kMesh: {
      const int x = std::clamp(static_cast<int>(std::floor(star.x + 0.5)), area.x0, area.x1() - 1);
      const int y = std::clamp(static_cast<int>(std::floor(star.y + 0.5)), area.y0, area.y1() - 1);
      const Row& under = row(y);
      const auto column = static_cast<std::size_t>(x - area.x0);
      const double rms = under.rms[column];
      return from_rms(under.level[column], mesh().level_error(rms), rms);
    }
    case BackgroundMethod::kLocal: {
      const AnnulusBackground annulus = annulus_background(frame_, 0, star, settings_.annulus_inner.value(),
                                                           settings_.annulus_outer.value(), settings_.annulus_clip);
      if (std::isfinite(annulus.level)) return from_rms(annulus.level, annulus.error, annulus.rms);
      SkyUnderStar sky = from_rms(mesh().median_level(), mesh().level_error(mesh().median_rms()), mesh().median_rms());
      sky.fallback = true;
      return sky;
    }
  }
  return {};
}

}  // namespace astroid::detail
