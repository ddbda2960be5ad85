#include "standard_scenes.hpp"

#include <cmath>
#include <limits>

#include "astroid/core/distributions.hpp"
#include "astroid/core/random.hpp"

namespace astroid {

namespace {

constexpr int kSide = 512;  // px

/// Stars of 2e3 to 1e6 e- at random places, the number of them inverse to their light.
StarCatalogue random_stars(std::size_t count) {
  constexpr double kFaintest = 2e3;
  constexpr double kBrightest = 1e6;
  constexpr double kSlope = -1.0;  // of electrons against rank
  StarCatalogue catalogue;
  catalogue.source = "standard scene";
  catalogue.passband = "P";
  catalogue.positions = PositionKind::kPixel;
  catalogue.brightness = BrightnessKind::kElectrons;
  const RandomStream stream = make_stream(1, StreamId{0}, 0, 0);
  const auto uniform = [&](std::size_t star, std::uint32_t axis) {
    return uniform_at_step(stream, {.step = star, .axis = axis});
  };
  for (std::size_t i = 0; i < count; ++i) {
    CatalogueStar star;
    star.id = "star" + std::to_string(i + 1);
    star.pixel = {kSide * uniform(i, 0) - 0.5, kSide * uniform(i, 1) - 0.5};
    star.electrons = std::min(kBrightest, kFaintest * std::pow(uniform(i, 2), kSlope));
    star.colour = star.teff = std::numeric_limits<double>::quiet_NaN();
    catalogue.stars.push_back(star);
  }
  return catalogue;
}

/// A PLATO camera with what every run has.
Mission camera() {
  Mission m;
  m.simulation.exposures = 200;
  m.telescope.cameras = 24;
  m.field.sky_background = ElectronsPerSecond(45.0);
  m.ccd.columns = m.ccd.rows = kSide;
  m.ccd.axis_x = m.ccd.axis_y = 0.5 * (kSide - 1);
  m.ccd.dark_current = ElectronsPerSecond(1.2);
  m.ccd.dsnu = 0.15;
  m.ccd.prnu = 0.01;
  m.ccd.readout_noise = Electrons(50.2);
  m.ccd.gain = Gain(25.0);
  m.ccd.bias = Adu(1000.0);
  return m;
}

void jitter(Mission& m, double arcsec) {
  m.satellite.jitter.model = JitterModel::kRedNoise;
  m.satellite.jitter.yaw = m.satellite.jitter.pitch = m.satellite.jitter.roll = Arcseconds(arcsec);
}

}  // namespace

std::vector<StandardScene> standard_scenes() {
  constexpr std::size_t kSparse = 60;  // so few that no maps are made
  constexpr std::size_t kFew = 600;
  constexpr std::size_t kMany = 12000;
  std::vector<StandardScene> scenes;
  const auto add = [&](const char* name, std::size_t stars) -> Mission& {
    scenes.push_back({.name = name, .mission = camera(), .catalogue = random_stars(stars)});
    return scenes.back().mission;
  };
  jitter(add("stars of a moving camera, Gaussian PSF", kFew), 0.04);
  jitter(add("a crowd, as a polynomial in the attitude", kMany), 0.04);
  add("a still image", kFew);
  {
    Mission& m = add("saturation", kFew);
    jitter(m, 0.04);
    m.ccd.full_well = Electrons(2e5);
  }
  {
    Mission& m = add("stars of a moving camera, Moffat PSF", kSparse);
    jitter(m, 0.04);
    m.psf.model = PsfModel::kMoffat;
  }
  {
    Mission& m = add("light that is rendered for each exposure", kFew);
    jitter(m, 0.3);
    m.field.stray_light = {ElectronsPerSecond(9.0), 0.5, -0.5};
    m.telescope.vignetting.model = VignettingModel::kCosineSquared;
    m.ccd.flat_field.rms = 0.01;
    m.ccd.charge_injection = {.every_rows = 100, .first_row = 0, .level = Electrons(1e4)};
    m.ccd.bad_pixels.dead = m.ccd.bad_pixels.hot = 1e-3;
    m.ccd.smearing = {.model = SmearingModel::kOpenShutter, .time = Seconds(4.0)};
    m.ccd.pixel_scale = PixelScale(100.0);
  }
  {
    Mission& m = add("charge that moves, two nodes", kFew);
    jitter(m, 0.04);
    m.ccd.cosmic_rays.rate = 10.0;
    m.ccd.brighter_fatter = {.serial = 3e-7, .parallel = 4e-7, .decay = 0.5, .range = 3};
    m.ccd.cti.model = CtiModel::kSimple;
    m.ccd.cti.parallel = m.ccd.cti.serial = 1e-5;
    m.ccd.nodes = {.count = 2, .gain_factor = {1.01, 0.99}, .noise_factor = {}, .cross_talk = 1e-3};
    m.ccd.electronics.nonlinearity = {0.0, -0.0042789409, 2.365e-7};
    m.ccd.electronics.bias_drift = 3.0;
    m.ccd.electronics.row_offset = 2.0;
    m.ccd.electronics.pick_up = {.amplitude = 1.0, .column_frequency = 0.21, .row_frequency = 0.03};
  }
  {
    Mission& m = add("a CMOS detector, four reads", kFew);
    jitter(m, 0.04);
    m.simulation.type = DetectorType::kCmos;
    m.cmos.reads = 4;
    m.cmos.gain_rms = 0.01;
    m.cmos.coupling = 0.01;
    m.cmos.column_noise = m.cmos.row_noise = Electrons(5.0);
    m.cmos.telegraph_fraction = 0.01;
    m.cmos.telegraph_current = ElectronsPerSecond(5.0);
  }
  {
    Mission& m = add("a CMOS detector that remembers, with a rolling shutter", kFew);
    jitter(m, 0.04);
    m.simulation.type = DetectorType::kCmos;
    m.cmos.persistence = {.fraction = {0.003, 0.001}, .time = {60.0, 900.0}};
    m.cmos.line_time = Seconds(0.04);
  }
  return scenes;
}

}  // namespace astroid
