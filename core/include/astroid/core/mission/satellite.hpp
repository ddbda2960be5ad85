// Where the spacecraft points, and how it moves.
#pragma once

#include <string>

#include "astroid/core/units.hpp"

namespace astroid {

enum class JitterModel { kNone, kRedNoise, kFile, kSpectrum };
enum class DriftModel { kNone, kLinear, kThermoElastic };

struct JitterSettings {
  JitterModel model = JitterModel::kNone;
  Arcseconds yaw, pitch, roll;  ///< rms
  Seconds timescale{250.0};
  /// Absolute path; columns time_s, yaw, pitch, roll (arcsec), or of the spectrum frequency_hz, yaw, pitch, roll
  /// (one-sided, arcsec²/Hz).
  std::string file;

  friend bool operator==(const JitterSettings&, const JitterSettings&) = default;
};

/// Slow motion of the lines of sight.
struct DriftSettings {
  DriftModel model = DriftModel::kNone;
  Arcseconds yaw, pitch, roll;  ///< linear: per day; thermo-elastic: peak to peak in one quarter

  friend bool operator==(const DriftSettings&, const DriftSettings&) = default;
};

/// The spacecraft turns about its axis once a quarter, and does not come back exactly.
struct RepointingSettings {
  double quarter_days = 0.0;    ///< length of a quarter; 0: never
  Arcseconds yaw, pitch, roll;  ///< rms of the pointing error of each quarter

  friend bool operator==(const RepointingSettings&, const RepointingSettings&) = default;
};

struct SatelliteSettings {
  Degrees ra, dec, roll;  ///< of the optical axis
  JitterSettings jitter;
  DriftSettings drift;
  RepointingSettings repointing;
  bool aberration = false;  ///< differential kinematic aberration, relative to the start of the run

  friend bool operator==(const SatelliteSettings&, const SatelliteSettings&) = default;
};

}  // namespace astroid
