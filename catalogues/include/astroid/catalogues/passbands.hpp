// Passbands: colour relations, and the conversion of a catalogue's magnitudes to another passband.
#pragma once

#include <string>
#include <string_view>

#include "astroid/catalogues/star_catalogue.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

/// The colour of stars that have none in their catalogue (StellarFieldSettings::assumed_bv and assumed_teff).
struct PassbandAssumptions {
  double bv = 0.6;       ///< Johnson B-V, mag
  double teff = 5778.0;  ///< K
};

/// The project's name of a passband: V, V_T, B_T, G, P, T or Kp for its usual spellings (VT, vtmag, Gaia G, TESS, …);
/// any other name is returned as it is, since a zero point may be stated in a passband of the user's own.
[[nodiscard]] std::string canonical_passband(std::string_view name);

/// V - V_T of a star. @source ESA1997 (vol. 1, 1.3.20): -0.090 (B_T - V_T). @valid -0.2 .. 1.8 (0.015 mag for
/// unreddened stars; up to 0.05 mag for M giants)
[[nodiscard]] DeltaMag v_minus_vt(double bt_vt);
/// Johnson B-V. @source ESA1997 (vol. 1, 1.3.20): 0.850 (B_T - V_T). @valid -0.2 .. 1.8
[[nodiscard]] double bv_from_bt_vt(double bt_vt);
/// G - V of a star. @source Riello2021 and the EDR3 documentation, table 5.9. @valid -0.5 .. 5.0 (scatter 0.030 mag)
[[nodiscard]] DeltaMag g_minus_v(double bp_rp);
/// V - P of a star. @source Marchiori2019 Eq. 8. @valid a falling cubic everywhere; used here from 3000 to 15000 K
[[nodiscard]] DeltaMag v_minus_p(double teff);

/// Teff in K. @source Ballesteros2012 (a black body seen in B and V; 5778 K at 0.65). @valid -0.4 .. 2.0
[[nodiscard]] double teff_from_bv(double bv);
/// The inverse of teff_from_bv, in closed form. @accuracy 1e-12 mag. @valid 3100 .. 21000 K
[[nodiscard]] double bv_from_teff(double teff);
/// Teff in K of a dwarf of solar metallicity. @source Mucciarelli2021 Table 1 (dwarfs, [Fe/H] = 0; scatter 61 K).
/// @valid 0.39 .. 1.50; differs: extended by its own quadratic to -0.3 .. 3.0, where it stays a smooth, falling
/// function
[[nodiscard]] double teff_from_bp_rp(double bp_rp);
/// The inverse of teff_from_bp_rp, in closed form. @accuracy 1e-12 mag. @valid 2960 .. 14900 K
[[nodiscard]] double bp_rp_from_teff(double teff);

/// Converts the magnitudes of a catalogue to the passband `to`, star by star, by way of the relations above:
/// B_T - V_T - V - P and V - G, in either direction.
///
/// A star without the colour that a relation wants takes it from another colour or Teff of its own, else the assumed
/// one. Colours outside a relation's range are taken at its edge. Both are counted in the catalogue's notes.
/// Electron catalogues and those already in `to` stay as they are. Colours and Teff do not change.
/// @throws InputError "passband mismatch: …" when there is no relation between the two passbands
/// @complexity O(stars)   @rng none   @thread safe for different catalogues
void convert_passband(StarCatalogue& catalogue, const std::string& to, const PassbandAssumptions& assumptions);

}  // namespace astroid
