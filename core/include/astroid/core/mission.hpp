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

}  // namespace astroid
