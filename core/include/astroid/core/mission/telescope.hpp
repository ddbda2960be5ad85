// The cameras and their optics, without the PSF.
#pragma once

#include <string>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

enum class DistortionModel { kNone, kRadial, kSip };
enum class VignettingModel { kNone, kCosineSquared, kPolynomial };

/// Departure of the optics from the projection, see RadialTangential and SipPolynomial.
struct DistortionSettings {
  DistortionModel model = DistortionModel::kNone;
  std::vector<double> radial;      ///< k1, k2, k3
  std::vector<double> tangential;  ///< p1, p2
  std::vector<double> prism;       ///< s1, s2
  std::string file;                ///< absolute path; FITS header with the SIP coefficients

  friend bool operator==(const DistortionSettings&, const DistortionSettings&) = default;
};

/// Light that the optics pass, less every year.
struct ThroughputSettings {
  double beginning_of_life = 1.0;  ///< relative to what zero point and sky background include
  double end_of_life = 1.0;        ///< after the lifetime, relative to the beginning of life; linear between
  double lifetime_years = 6.5;
  double age_years = 0.0;  ///< at the start of the run

  friend bool operator==(const ThroughputSettings&, const ThroughputSettings&) = default;
};

/// Light lost towards the edge of the field, relative to the axis.
struct VignettingSettings {
  VignettingModel model = VignettingModel::kNone;
  std::vector<double> polynomial;  ///< percent lost: coefficients of x², x⁴, x⁶, x the field angle in degrees

  friend bool operator==(const VignettingSettings&, const VignettingSettings&) = default;
};

/// Images of bright stars by reflection, on the other side of the optical axis.
struct GhostSettings {
  double fraction = 0.0;         ///< of the star's light; 0: none
  Pixels radius{50.0};           ///< of the disc
  Magnitude brighter_than{8.0};  ///< stars that have one

  friend bool operator==(const GhostSettings&, const GhostSettings&) = default;
};

/// Cameras that look, read out or have aged otherwise than others. Every list but the first is empty, or says one
/// number of each group.
struct CameraGroups {
  std::vector<int> cameras;         ///< of each group; empty: all cameras are alike
  std::vector<double> tilt;         ///< deg, from the spacecraft's pointing to the group's axis
  std::vector<double> azimuth;      ///< deg, of the tilt, from +x to +y
  std::vector<double> roll;         ///< deg, about the group's axis
  std::vector<double> stagger;      ///< s
  std::vector<double> offset_x;     ///< px, added to the pixel where the axis falls
  std::vector<double> offset_y;     ///< px
  std::vector<double> throughput;   ///< relative to ThroughputSettings::beginning_of_life
  std::vector<double> end_of_life;  ///< in place of ThroughputSettings::end_of_life

  friend bool operator==(const CameraGroups&, const CameraGroups&) = default;
};

struct TelescopeSettings {
  Magnitude zero_point{20.62};  ///< magnitude that gives one detected electron per second
  std::string zero_point_passband = "P";
  int cameras = 24;           ///< that observe the field
  int simulated_cameras = 1;  ///< n <= cameras; independent terms are scaled to `cameras`
  CameraGroups groups;
  int group = -1;  ///< the group that sees this mission, set by group_mission(); -1: not one of several
  ThroughputSettings throughput;
  DistortionSettings distortion;
  VignettingSettings vignetting;
  GhostSettings ghosts;

  friend bool operator==(const TelescopeSettings&, const TelescopeSettings&) = default;
};

}  // namespace astroid
