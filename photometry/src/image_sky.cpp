#include "image_sky.hpp"

#include <algorithm>
#include <cmath>

namespace astroid::detail {

ImageSky::ImageSky(const Frame& frame, const ImagePhotometrySettings& settings) : frame_(frame), settings_(settings) {
  if (settings.background != BackgroundMethod::kMesh) return;
  const Rectangle& area = frame.pixels.layout().regions()[0];
  mesh_level_ = Image<double, unit::Adu>(area);
  mesh_rms_ = Image<double, unit::Adu>(area);
  for (int y = area.y0; y < area.y1(); ++y) {
    mesh().level_row(y, mesh_level_.row(y));
    mesh().rms_row(y, mesh_rms_.row(y));
  }
}

const BackgroundMap& ImageSky::mesh() {
  if (!mesh_) mesh_.emplace(frame_, 0, settings_.mesh);
  return *mesh_;
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
      const double rms = mesh_rms_.at(x, y);
      return from_rms(mesh_level_.at(x, y), mesh().level_error(rms), rms);
    }
    case BackgroundMethod::kLocal: {
      const AnnulusBackground annulus =
          annulus_background(frame_, 0, star, settings_.annulus_inner.value(), settings_.annulus_outer.value());
      if (std::isfinite(annulus.level)) return from_rms(annulus.level, annulus.error, annulus.rms);
      SkyUnderStar sky = from_rms(mesh().median_level(), mesh().level_error(mesh().median_rms()), mesh().median_rms());
      sky.fallback = true;
      return sky;
    }
  }
  return {};
}

}  // namespace astroid::detail
