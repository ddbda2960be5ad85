// The names by which catalogues call their columns.
#pragma once

#include <array>
#include <string_view>

namespace astroid {

inline constexpr std::array<std::string_view, 16> kIdNames{
    "id",    "star_id", "source_id", "designation", "dr3name", "source", "tic",   "tic_id",
    "ticid", "kic",     "kepid",     "kic_id",      "hip",     "tyc",    "tycho", "name"};
inline constexpr std::array<std::string_view, 10> kRaNames{
    "ra", "ra_icrs", "raj2000", "radeg", "ra_deg", "_raj2000", "ramdeg", "ra(icrs)", "ra_j2000", "right_ascension"};
inline constexpr std::array<std::string_view, 12> kDecNames{"dec",      "de_icrs",  "dej2000",   "dedeg",
                                                            "dec_deg",  "_dej2000", "demdeg",    "de(icrs)",
                                                            "dec_icrs", "decj2000", "dec_j2000", "declination"};
inline constexpr std::array<std::string_view, 1> kXNames{"x"};
inline constexpr std::array<std::string_view, 1> kYNames{"y"};
inline constexpr std::array<std::string_view, 2> kElectronNames{"electrons", "electrons_per_exposure"};
/// Columns whose passband only the user knows.
inline constexpr std::array<std::string_view, 2> kMagnitudeNames{"mag", "magnitude"};
inline constexpr std::array<std::string_view, 5> kTeffNames{"teff", "teff_gspphot", "teff_val", "teff_k", "t_eff"};

/// Proper motions, mas/yr, that of right ascension times cos(dec); and the Julian year of the positions.
inline constexpr std::array<std::string_view, 3> kPmRaNames{"pmra", "pm_ra", "pmra_mas"};
inline constexpr std::array<std::string_view, 5> kPmDecNames{"pmdec", "pm_dec", "pmde", "pm_de", "pmdec_mas"};
inline constexpr std::array<std::string_view, 3> kEpochNames{"ref_epoch", "epoch", "refepoch"};

/// A magnitude column whose name tells the passband. `exact`: its case matters.
struct MagnitudeName {
  std::string_view name;
  std::string_view passband;
  bool exact = false;
};
// Exact: gmag and bmag belong to other surveys' bands.
inline constexpr std::array<MagnitudeName, 17> kPassbandNames{{
    {"phot_g_mean_mag", "G"},
    {"gaiamag", "G"},
    {"Gmag", "G", true},
    {"vtmag", "V_T"},
    {"vt_mag", "V_T"},
    {"btmag", "B_T"},
    {"bt_mag", "B_T"},
    {"vmag", "V"},
    {"v_mag", "V"},
    {"Bmag", "B", true},
    {"pmag", "P"},
    {"tmag", "T"},
    {"tessmag", "T"},
    {"tess_mag", "T"},
    {"kepmag", "Kp"},
    {"kpmag", "Kp"},
    {"Kp", "Kp", true},
}};

struct ColourName {
  std::string_view index;
  std::array<std::string_view, 3> names;
  std::array<std::string_view, 2> blue;  ///< names of the two magnitudes, paired
  std::array<std::string_view, 2> red;
};
inline constexpr std::array<ColourName, 3> kColourNames{{
    {"B-V", {"bv", "b_v", "b-v"}, {"Bmag", "b_mag"}, {"Vmag", "v_mag"}},
    {"B_T-V_T", {"bt_vt", "btvt", "bt-vt"}, {"btmag", "bt_mag"}, {"vtmag", "vt_mag"}},
    {"BP-RP", {"bp_rp", "bp-rp", "bprp"}, {"phot_bp_mean_mag", "BPmag"}, {"phot_rp_mean_mag", "RPmag"}},
}};

}  // namespace astroid
