// How the ground measures.
#pragma once

#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

enum class PhotometryMethod { kAperture, kMask, kWeighted, kPsf };
enum class BackgroundMethod { kKnown, kLocal, kMesh };
enum class BiasSource { kKnown, kPrescan };
enum class JitterCorrection { kNone, kKnown, kCentroids };

/// What is taken out of an image before it is measured.
struct CalibrationSettings {
  BiasSource bias = BiasSource::kKnown;
  bool smearing = false;                          ///< by the parallel overscan
  bool nonlinearity = false;                      ///< by the inverse of the believed polynomial
  std::vector<double> nonlinearity_coefficients;  ///< believed a0, a1, a2; none: those of the detector
  bool gain = true;                               ///< of each node, instead of the mean one

  friend bool operator==(const CalibrationSettings&, const CalibrationSettings&) = default;
};

/// How wrong the ground is about what it knows.
struct KnowledgeSettings {
  Arcseconds attitude{0.0};  ///< rms of the attitude of an exposure that the spacecraft tells, each axis

  friend bool operator==(const KnowledgeSettings&, const KnowledgeSettings&) = default;
};

struct PhotometrySettings {
  PhotometryMethod method = PhotometryMethod::kMask;
  Pixels aperture_radius{3.0};
  int mask_window = 6;        ///< side of the window in which masks may grow and PSF weights are, px
  Seconds mask_refresh{0.0};  ///< apertures, masks and weights are made anew for the stars' places this often; 0: never
  Pixels mask_reach{0.0};     ///< neighbours farther than this add nothing; 0: from the accuracy
  BackgroundMethod background = BackgroundMethod::kLocal;
  Pixels annulus_inner{5.0}, annulus_outer{8.0};
  int mesh = 64;
  Magnitude target_limit{99.0};  ///< stars brighter than this are targets
  CalibrationSettings calibration;
  JitterCorrection jitter_correction = JitterCorrection::kNone;
  int cotrending = 0;  ///< common trends that are taken out of bin means, at most
  KnowledgeSettings knowledge;

  friend bool operator==(const PhotometrySettings&, const PhotometrySettings&) = default;
};

}  // namespace astroid
