// Reads star catalogues from files of many makes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "astroid/catalogues/star_catalogue.hpp"

namespace astroid {

enum class AngleUnit { kDegrees, kRadians };

/// What the user states about a catalogue file.
struct CatalogueOptions {
  /// Passband of the magnitudes. Empty: what the column's name implies (Gmag: G); an error where it implies nothing.
  std::string passband{};
  AngleUnit unit = AngleUnit::kDegrees;  ///< of right ascension and declination
  /// Reads ids and positions alone: no brightness column is needed, and none is read.
  bool positions_only = false;
  /// Leaves out stars without a magnitude, and counts them in the notes; otherwise each of them is an error.
  bool leave_out_missing = false;
  /// Refuses positions stated in degrees whose star density only makes sense in radians.
  bool check_unit = true;
  std::size_t most_problems = 20;  ///< more of them are only counted
};

/// Reads a star catalogue: CSV, TSV, ECSV or blank-separated text, or the first table of a FITS file.
///
/// Columns are known by name (case ignored unless it tells Gaia's G from another survey's g):
///  position    ra, dec; RA_ICRS, DE_ICRS; RAJ2000, DEJ2000; …  or x, y (0-based detector pixels)
///  brightness  mag; Gmag, phot_g_mean_mag, GAIAmag (G); VTmag (V_T); BTmag (B_T); Vmag (V); Tmag (T); Pmag (P);
///              Kpmag, kepmag (Kp); or electrons (per exposure, for pixel positions)
///  optional    id, source_id, ID, …; bv, bt_vt, bp_rp, or the two magnitudes of the colour; teff
/// Among several magnitude columns the stated passband chooses. A file without a header holds ra dec mag.
/// Stars without an id are named "h" + 16 hexadecimal digits, a hash of the position to 1e-7 deg (1e-7 px); further
/// stars at the same position get "-2", "-3", … in the order of the file.
///
/// @throws InputError with all problems at once (file, line, column, value): columns that are missing, cells that are
///   not a number, NaN or out of range, duplicate ids with both lines, radians for degrees and the reverse, a column
///   whose passband contradicts the stated one, no stars. EnvironmentError(path, cause)
/// @complexity O(stars)   @rng none   @thread safe
[[nodiscard]] StarCatalogue read_catalogue(const std::filesystem::path& path, const CatalogueOptions& options = {});

}  // namespace astroid
