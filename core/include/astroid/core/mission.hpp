// The configuration as plain structs: one per section of the XML file, parsed once. Physics takes these, never a key.
#pragma once

#include "astroid/core/mission/detector.hpp"
#include "astroid/core/mission/photometry.hpp"
#include "astroid/core/mission/psf.hpp"
#include "astroid/core/mission/results.hpp"
#include "astroid/core/mission/satellite.hpp"
#include "astroid/core/mission/simulation.hpp"
#include "astroid/core/mission/stellar_field.hpp"
#include "astroid/core/mission/telescope.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

struct Mission {
  SimulationSettings simulation;
  SatelliteSettings satellite;
  TelescopeSettings telescope;
  PsfSettings psf;
  StellarFieldSettings field;
  CcdSettings ccd;
  CmosSettings cmos;
  PhotometrySettings photometry;
  AnalysisSettings analysis;
  OutputSettings output;

  friend bool operator==(const Mission&, const Mission&) = default;
};

/// Time from the start of the mission (quarter 0) to that of the run. What is periodic, ages or varies goes on from
/// quarter to quarter.
inline Seconds quarter_start(const Mission& mission) {
  return Seconds(static_cast<double>(mission.simulation.quarter) * mission.satellite.quarter_days * kSecondsPerDay);
}

/// By which a row is exposed later than the one below it: of a CMOS detector with a rolling shutter.
inline Seconds line_time(const Mission& mission) {
  return mission.simulation.type == DetectorType::kCmos ? mission.cmos.line_time : Seconds(0.0);
}

}  // namespace astroid
