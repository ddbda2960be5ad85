// Small scenes for tests: a mission of a few lines and catalogues in pixels and electrons.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/mission.hpp"

namespace astroid::test {

/// A star of a laboratory scene.
struct LabStar {
  double x, y, electrons;
};

/// A CCD of the given size with every effect off: no sky, no dark, no noise but that of photons, gain 1, bias 0.
inline Mission bare_mission(int columns, int rows) {
  Mission mission;
  mission.simulation.seed = 42;
  mission.simulation.exposures = 4;
  mission.simulation.start_mjd = 61406.0;
  mission.satellite.ra = Degrees(95.3104);
  mission.satellite.dec = Degrees(-47.8869);
  mission.telescope.cameras = 1;
  mission.ccd.columns = columns;
  mission.ccd.rows = rows;
  mission.ccd.axis_x = 0.5 * (columns - 1);
  mission.ccd.axis_y = 0.5 * (rows - 1);
  mission.ccd.full_well = Electrons(1e12);
  mission.ccd.adc_bits = 24;
  mission.photometry.background = BackgroundMethod::kKnown;
  return mission;
}

/// The same with PLATO's sky, dark current, DSNU, PRNU, readout noise, gain, bias, full well and jitter.
inline Mission plato_mission(int columns, int rows) {
  Mission mission = bare_mission(columns, rows);
  mission.telescope.cameras = 24;
  mission.field.sky_background = ElectronsPerSecond(45.0);
  mission.ccd.dark_current = ElectronsPerSecond(1.2);
  mission.ccd.dsnu = 0.15;
  mission.ccd.prnu = 0.01;
  mission.ccd.readout_noise = Electrons(50.2);
  mission.ccd.gain = Gain(25.0);
  mission.ccd.bias = Adu(1000.0);
  mission.ccd.full_well = Electrons(900000.0);
  mission.ccd.adc_bits = 16;
  mission.satellite.jitter.model = JitterModel::kRedNoise;
  mission.satellite.jitter.yaw = Arcseconds(0.038);
  mission.satellite.jitter.pitch = Arcseconds(0.038);
  mission.satellite.jitter.roll = Arcseconds(0.040);
  return mission;
}

/// A catalogue of stars at given pixels with given electrons per exposure.
inline StarCatalogue lab_catalogue(const std::vector<LabStar>& stars) {
  StarCatalogue catalogue;
  catalogue.source = "laboratory";
  catalogue.passband = "P";
  catalogue.positions = PositionKind::kPixel;
  catalogue.brightness = BrightnessKind::kElectrons;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    CatalogueStar star;
    star.id = "star" + std::to_string(i + 1);
    star.pixel = {stars[i].x, stars[i].y};
    star.electrons = stars[i].electrons;
    star.colour = std::numeric_limits<double>::quiet_NaN();
    star.teff = std::numeric_limits<double>::quiet_NaN();
    catalogue.stars.push_back(star);
  }
  return catalogue;
}

}  // namespace astroid::test
