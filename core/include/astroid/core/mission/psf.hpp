// The point-spread function.
#pragma once

#include <string>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

enum class PsfModel { kGaussian, kTable, kMoffat, kAiry, kField };

/// Width that follows the temperature.
struct BreathingSettings {
  double amplitude = 0.0;  ///< of the width, relative; 0: none
  Seconds period{86400.0};
  double phase = 0.0;  ///< turns at the start of the run

  friend bool operator==(const BreathingSettings&, const BreathingSettings&) = default;
};

enum class IntraPixelProfile { kEdge, kCosine, kGaussian };

/// Sensitivity within a pixel, relative to the pixel's mean: highest at its centre, lower towards its edges.
struct IntraPixelSettings {
  IntraPixelProfile profile = IntraPixelProfile::kEdge;
  double depth = 0.0;  ///< relative loss at the edge; 0: none
  Pixels width{0.1};   ///< of the zone along the edge in which it is lost (edge profile)
  int cells = 10;      ///< per pixel and axis, in each of which sensitivity is constant
  double flat = 0.0;   ///< rms of the cells' own sensitivity, different in every pixel; 0: all pixels are alike

  friend bool operator==(const IntraPixelSettings&, const IntraPixelSettings&) = default;
};

struct PsfSettings {
  PsfModel model = PsfModel::kGaussian;
  Pixels sigma{0.6};             ///< of the Gaussian
  Pixels fwhm{1.5};              ///< of the Moffat profile
  double beta = 3.5;             ///< of the Moffat profile
  Pixels lambda_over_d{1.0};     ///< of the Airy pattern
  double obscuration = 0.0;      ///< diameter of the central obscuration relative to the aperture
  std::string file;              ///< absolute path; of the table and field models
  int phases = 0;                ///< of the prf renderer, 0: from the accuracy
  Pixels stamp_half_width{0.0};  ///< 0: from the accuracy
  Pixels diffusion{0.0};         ///< sigma of the charge diffusion; 0: none
  BreathingSettings breathing;
  IntraPixelSettings intra_pixel;

  friend bool operator==(const PsfSettings&, const PsfSettings&) = default;
};

}  // namespace astroid
