// The detector: what CCD and CMOS share, and what each has alone.
#pragma once

#include <string>
#include <vector>

#include "astroid/core/ramp.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

enum class SmearingModel { kNone, kOpenShutter, kFrameTransfer };
enum class CtiModel { kNone, kSimple, kTraps };
enum class CosmicRayKind { kTrail, kSlab };

/// Pixels read beyond the light-sensitive ones.
struct ReferencePixels {
  int prescan = 0;            ///< columns before the first one
  int serial_overscan = 0;    ///< columns after the last one
  int parallel_overscan = 0;  ///< rows after the last one

  friend bool operator==(const ReferencePixels&, const ReferencePixels&) = default;
};

/// Light that falls on the pixels while charge is moved.
struct SmearingSettings {
  SmearingModel model = SmearingModel::kNone;
  Seconds time{4.019};        ///< of moving all rows past the light, after the exposure
  Seconds clear_time{4.019};  ///< the same before the exposure; of frame transfer alone

  friend bool operator==(const SmearingSettings&, const SmearingSettings&) = default;
};

/// A pattern of sensitivity with a power-law spatial spectrum.
struct FlatFieldSettings {
  double rms = 0.0;       ///< relative; 0: none
  double exponent = 1.0;  ///< of the power spectrum, f^-exponent

  friend bool operator==(const FlatFieldSettings&, const FlatFieldSettings&) = default;
};

/// Lines of charge injected into every nth row.
struct ChargeInjectionSettings {
  int every_rows = 0;  ///< 0: none
  int first_row = 0;
  Electrons level{0.0};  ///< of each pixel of such a row

  friend bool operator==(const ChargeInjectionSettings&, const ChargeInjectionSettings&) = default;
};

struct CosmicRaySettings {
  double rate = 0.0;  ///< hits per cm² and second; 0: none
  CosmicRayKind model = CosmicRayKind::kTrail;
  Pixels longest_track{15.0};                               ///< on the detector; trails are uniform from 0
  Electrons charge_location{2500.0}, charge_scale{2000.0};  ///< of the skew-normal distribution of a trail's charge
  double charge_shape = 30.0;
  double thickness = 16.0;    ///< of the slab, micrometres
  double path_charge = 80.0;  ///< most probable, electrons per micrometre of path in the slab
  double fluctuation = 0.1;   ///< Moyal width of that charge, relative

  friend bool operator==(const CosmicRaySettings&, const CosmicRaySettings&) = default;
};

/// How collected charge shifts pixel boundaries.
struct BrighterFatterSettings {
  double serial = 0.0;    ///< shift of a boundary between columns by an electron in a pixel next to it, px/e-; 0: none
  double parallel = 0.0;  ///< the same of a boundary between rows
  double decay = 0.5;     ///< of the shift with distance, 1/px
  int range = 4;          ///< pixels

  friend bool operator==(const BrighterFatterSettings&, const BrighterFatterSettings&) = default;
};

/// Charge-transfer inefficiency.
struct CtiSettings {
  CtiModel model = CtiModel::kNone;
  double parallel = 0.0;                   ///< share of the charge lost per transfer between rows (simple model)
  double serial = 0.0;                     ///< and between columns
  double beta = 0.37;                      ///< exponent of the volume of a charge packet (trap model)
  double temperature = 203.0;              ///< K
  Seconds row_time{0.0007718};             ///< time that charge stays in one row
  Seconds column_time{3.4e-7};             ///< and in one element of the register
  std::vector<double> trap_density;        ///< per pixel, one for each species
  std::vector<double> register_density;    ///< the same in the register; empty: none
  std::vector<double> trap_cross_section;  ///< m²
  std::vector<double> trap_release_time;   ///< s

  friend bool operator==(const CtiSettings&, const CtiSettings&) = default;
};

/// One amplifier and its electronics read a part of the columns.
struct NodeSettings {
  int count = 1;                     ///< 1, 2 or 4
  std::vector<double> gain_factor;   ///< of each, relative to the gain
  std::vector<double> noise_factor;  ///< of each, relative to the readout noise
  double cross_talk = 0.0;           ///< share of one node's signal that the others gain

  friend bool operator==(const NodeSettings&, const NodeSettings&) = default;
};

/// A sinusoid along the readout that interference adds.
struct PickUpSettings {
  double amplitude = 0.0;         ///< ADU
  double column_frequency = 0.0;  ///< cycles per pixel from column to column
  double row_frequency = 0.0;     ///< cycles per pixel from row to row

  friend bool operator==(const PickUpSettings&, const PickUpSettings&) = default;
};

struct ElectronicsSettings {
  std::vector<double> nonlinearity;  ///< a0, a1, a2 of ADU' = ADU + a0 + a1 ADU + a2 ADU²; none: linear
  double gain_drift = 0.0;           ///< relative, amplitude over one period
  double bias_drift = 0.0;           ///< ADU, amplitude over one period
  Seconds drift_period{86400.0};
  double row_offset = 0.0;  ///< ADU rms, of each row of each exposure
  PickUpSettings pick_up;

  friend bool operator==(const ElectronicsSettings&, const ElectronicsSettings&) = default;
};

/// Pixels that do not work.
struct BadPixelSettings {
  double dead = 0.0;  ///< fraction that sees no light
  double hot = 0.0;   ///< fraction with a large dark current
  ElectronsPerSecond hot_current{1000.0};
  std::string file{};  ///< absolute path of a list or mask of others, the same in all cameras; empty: none

  friend bool operator==(const BadPixelSettings&, const BadPixelSettings&) = default;
};

struct CcdSettings {
  int columns = 0, rows = 0;
  PixelScale pixel_scale{15.0};
  double pixel_size = 18.0;           ///< micrometres
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
  ReferencePixels reference;
  SmearingSettings smearing;
  FlatFieldSettings flat_field;
  ChargeInjectionSettings charge_injection;
  CosmicRaySettings cosmic_rays;
  BrighterFatterSettings brighter_fatter;
  CtiSettings cti;
  NodeSettings nodes;
  ElectronicsSettings electronics;
  BadPixelSettings bad_pixels;

  friend bool operator==(const CcdSettings&, const CcdSettings&) = default;
};

/// Charge that traps take from an exposure and release in the following ones, one share for each kind of trap.
struct PersistenceSettings {
  std::vector<double> fraction;  ///< of the charge of an exposure that is in traps at its end; empty: none
  std::vector<double> time;      ///< s, mean time after which each kind releases it

  friend bool operator==(const PersistenceSettings&, const PersistenceSettings&) = default;
};

/// What only a CMOS detector has; CcdSettings holds the rest.
struct CmosSettings {
  /// Reads of an exposure. 1: at its end, after a reset at its beginning. More: non-destructive, evenly spaced, the
  /// first at the beginning of the exposure, the last at its end.
  int reads = 1;
  RampFit ramp_fit = RampFit::kOptimal;
  Electrons reset_noise{0.0};       ///< kTC, rms
  double gain_rms = 0.0;            ///< of the pixels' gain, relative
  Adu offset_rms{0.0};              ///< of the pixels' offset
  double noise_rms = 0.0;           ///< of the logarithm of the pixels' readout noise; CCD/ReadoutNoise is its rms
  double coupling = 0.0;            ///< inter-pixel capacitance: share of each of the four neighbours at the sides
  double corner_coupling = 0.0;     ///< and at the corners
  Electrons column_noise{0.0};      ///< rms, of each column of each read
  Electrons row_noise{0.0};         ///< rms, of each row of each read
  double telegraph_fraction = 0.0;  ///< of the pixels
  ElectronsPerSecond telegraph_current{0.0};  ///< dark current that their high state has more than their low one
  Seconds telegraph_low{1000.0}, telegraph_high{1000.0};  ///< mean stay in each state
  PersistenceSettings persistence;
  Seconds line_time{0.0};  ///< by which each row begins and ends its exposure later than the one below; 0: all at once

  friend bool operator==(const CmosSettings&, const CmosSettings&) = default;
};

}  // namespace astroid
