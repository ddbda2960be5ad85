// The configuration as plain structs: one per section of the XML file, parsed once. Physics takes these, never a key.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "astroid/core/units.hpp"

namespace astroid {

enum class DetectorType { kCcd, kCmos };
enum class JitterModel { kNone, kRedNoise, kFile };
enum class PsfModel { kGaussian, kTable };
enum class PhotometryMethod { kAperture, kMask, kWeighted, kPsf };
enum class BackgroundMethod { kKnown, kLocal, kMesh };
enum class ImageOutput { kNone, kFirst, kEvery, kAll };
enum class LightCurveOutput { kNone, kTargets, kAll };

struct SimulationSettings {
  DetectorType type = DetectorType::kCcd;
  std::uint64_t seed = 1;
  Ppm accuracy{1.0};
  std::int64_t exposures = 1;
  Seconds cycle{25.0};
  Seconds exposure_time{21.0};
  std::string start = "2027-01-01T00:00:00";  ///< TDB, ISO 8601
  double start_mjd = 61406.0;                 ///< the same as MJD (TDB), filled by the reader

  friend bool operator==(const SimulationSettings&, const SimulationSettings&) = default;
};

struct JitterSettings {
  JitterModel model = JitterModel::kNone;
  Arcseconds yaw, pitch, roll;  ///< rms
  Seconds timescale{250.0};
  std::string file;  ///< absolute path; columns time_s, yaw, pitch, roll (arcsec)

  friend bool operator==(const JitterSettings&, const JitterSettings&) = default;
};

/// Slow motion of the line of sight, which begins anew in each quarter.
struct DriftSettings {
  Arcseconds yaw, pitch, roll;                 ///< thermo-elastic: bound of the excursion within a quarter
  Arcseconds yaw_rate, pitch_rate, roll_rate;  ///< linear: per day

  friend bool operator==(const DriftSettings&, const DriftSettings&) = default;
};

/// Rms of the pointing error of each quarter but the first.
struct RepointingSettings {
  Arcseconds yaw, pitch, roll;

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

struct TelescopeSettings {
  Magnitude zero_point{20.62};  ///< magnitude that gives one detected electron per second
  std::string zero_point_passband = "P";
  int cameras = 24;           ///< that observe the field
  int simulated_cameras = 1;  ///< n <= cameras; independent terms are scaled to `cameras`

  friend bool operator==(const TelescopeSettings&, const TelescopeSettings&) = default;
};

struct PsfSettings {
  PsfModel model = PsfModel::kGaussian;
  Pixels sigma{0.6};
  std::string file;              ///< absolute path; of the table model
  int phases = 0;                ///< of the prf renderer, 0: from the accuracy
  Pixels stamp_half_width{0.0};  ///< 0: from the accuracy

  friend bool operator==(const PsfSettings&, const PsfSettings&) = default;
};

struct StellarFieldSettings {
  std::string catalogue;  ///< absolute path
  std::string catalogue_passband = "V";
  std::string catalogue_unit = "deg";      ///< of ra and dec: deg or rad
  double assumed_bv = 0.6;                 ///< colour B-V in the catalogue's system where the catalogue has none
  double assumed_teff = 5778.0;            ///< K, for V -> P where the catalogue has none
  Magnitude faint_limit{99.0};             ///< stars fainter than this are left out
  std::string background_catalogue;        ///< absolute path; optional second file, e.g. made by `astroid field`
  ElectronsPerSecond sky_background{0.0};  ///< per pixel, detected

  friend bool operator==(const StellarFieldSettings&, const StellarFieldSettings&) = default;
};

struct CcdSettings {
  int columns = 0, rows = 0;
  PixelScale pixel_scale{15.0};
  std::string projection = "TAN";     ///< a zenithal projection of FITS WCS
  double axis_x = 0.0, axis_y = 0.0;  ///< pixel where the optical axis falls; default the centre
  bool has_sub_field = false;
  int sub_x0 = 0, sub_y0 = 0, sub_columns = 0, sub_rows = 0;
  int window = 0;  ///< side of the window around each target, px; 0: no windows
  Electrons full_well{900000.0};
  bool blooming = true;
  ElectronsPerSecond dark_current{0.0};  ///< per pixel
  double dsnu = 0.0;                     ///< rms relative to the dark current
  double prnu = 0.0;                     ///< rms relative
  Electrons readout_noise{0.0};
  Gain gain{1.0};
  Adu bias{0.0};
  int adc_bits = 16;

  friend bool operator==(const CcdSettings&, const CcdSettings&) = default;
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

  friend bool operator==(const PhotometrySettings&, const PhotometrySettings&) = default;
};

struct AnalysisSettings {
  Seconds bin{3600.0};               ///< duration to which noise is averaged
  double uncontaminated_spr = 1e-3;  ///< stars with less contamination judge magnitude recovery

  friend bool operator==(const AnalysisSettings&, const AnalysisSettings&) = default;
};

struct OutputSettings {
  ImageOutput images = ImageOutput::kFirst;
  int images_every = 1;
  LightCurveOutput light_curves = LightCurveOutput::kTargets;
  std::vector<std::int64_t> dump_steps;  ///< exposures whose intermediate maps are written

  friend bool operator==(const OutputSettings&, const OutputSettings&) = default;
};

struct Mission {
  SimulationSettings simulation;
  SatelliteSettings satellite;
  TelescopeSettings telescope;
  PsfSettings psf;
  StellarFieldSettings field;
  CcdSettings ccd;
  PhotometrySettings photometry;
  AnalysisSettings analysis;
  OutputSettings output;

  friend bool operator==(const Mission&, const Mission&) = default;
};

}  // namespace astroid
