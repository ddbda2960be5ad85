// Where the spacecraft points, and how it moves.
#pragma once

#include <string>

#include "astroid/core/units.hpp"

namespace astroid {

enum class JitterModel { kNone, kRedNoise, kFile, kSpectrum };

struct JitterSettings {
  JitterModel model = JitterModel::kNone;
  Arcseconds yaw, pitch, roll;  ///< rms
  Seconds timescale{250.0};
  /// Absolute path; columns time_s, yaw, pitch, roll (arcsec), or of the spectrum frequency_hz, yaw, pitch, roll
  /// (one-sided, arcsec²/Hz).
  std::string file;

  friend bool operator==(const JitterSettings&, const JitterSettings&) = default;
};

/// Slow motion of the line of sight, which begins anew in each quarter.
struct DriftSettings {
  Arcseconds yaw, pitch, roll;                 ///< thermo-elastic: bound of the excursion within a quarter
  Arcseconds yaw_rate, pitch_rate, roll_rate;  ///< linear: per day

  friend bool operator==(const DriftSettings&, const DriftSettings&) = default;
};

/// Rms of the pointing error of each quarter but the first, and the turn between two quarters.
struct RepointingSettings {
  Arcseconds yaw, pitch, roll;
  Degrees turn;  ///< about the optical axis, by which each quarter is rolled further than the one before

  friend bool operator==(const RepointingSettings&, const RepointingSettings&) = default;
};

struct SatelliteSettings {
  Degrees ra, dec, roll;  ///< of the optical axis
  JitterSettings jitter;
  DriftSettings drift;
  double quarter_days = 90.0;  ///< after which the spacecraft is pointed anew; 0: never
  RepointingSettings repointing;
  bool aberration = false;  ///< differential kinematic aberration, relative to the start of the run

  friend bool operator==(const SatelliteSettings&, const SatelliteSettings&) = default;
};

}  // namespace astroid
