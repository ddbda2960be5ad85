// How the ground measures.
#pragma once

#include "astroid/core/units.hpp"

namespace astroid {

enum class PhotometryMethod { kAperture, kMask, kWeighted, kPsf };
enum class BackgroundMethod { kKnown, kLocal, kMesh };
enum class BiasSource { kKnown, kPrescan };

/// What is taken out of an image before it is measured.
struct CalibrationSettings {
  BiasSource bias = BiasSource::kKnown;
  bool smearing = false;      ///< by the parallel overscan
  bool nonlinearity = false;  ///< by the inverse of the known polynomial

  friend bool operator==(const CalibrationSettings&, const CalibrationSettings&) = default;
};

struct PhotometrySettings {
  PhotometryMethod method = PhotometryMethod::kMask;
  Pixels aperture_radius{3.0};
  int mask_window = 6;     ///< side of the window in which masks may grow and PSF weights are, px
  Pixels mask_reach{0.0};  ///< neighbours farther than this add nothing; 0: from the accuracy
  BackgroundMethod background = BackgroundMethod::kLocal;
  Pixels annulus_inner{5.0}, annulus_outer{8.0};
  int mesh = 64;
  bool subtract_bias = true;
  bool apply_gain = true;
  Magnitude target_limit{99.0};  ///< stars brighter than this are targets
  CalibrationSettings calibration;

  friend bool operator==(const PhotometrySettings&, const PhotometrySettings&) = default;
};

}  // namespace astroid
