// Header cards as CFITSIO writes them: the part that every way of writing a FITS file shares.
#pragma once

#include <fitsio.h>

#include <string>
#include <string_view>

#include "astroid/core/fits_card.hpp"

namespace astroid {

/// Printable ASCII stays, every other byte becomes '?'.
[[nodiscard]] std::string printable_ascii(std::string_view text);

/// The 80 characters of a card whose value fits on one line. @throws BugError otherwise, or when the keyword is none.
[[nodiscard]] std::string fits_card_line(const FitsCard& card);

/// Replaces the card of that keyword in the text of a header. @throws BugError also when it is not there.
void replace_fits_card(std::string& header, const FitsCard& card);

/// When the unit is written (UTC, of SOURCE_DATE_EPOCH if that is set).
[[nodiscard]] FitsCard fits_date_card();

/// Sets a keyword of the current unit; an old value of it is replaced. Texts too long for a card continue on the next.
/// @param status  CFITSIO's: nothing is done unless it is 0.  @throws BugError when the keyword is none.
void set_fits_card(fitsfile* file, const FitsCard& card, int* status);

/// Adds a HISTORY line, continued over several cards when it is long.
void add_fits_history(fitsfile* file, std::string_view line, int* status);

/// The cards that every unit ends its beginning with: EXTNAME if named, DATE, and CHECKSUM and DATASUM, to be
/// filled in when the unit is complete.
void set_fits_unit_cards(fitsfile* file, const std::string& name, int* status);

}  // namespace astroid
