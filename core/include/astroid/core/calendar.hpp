// Calendar dates and Modified Julian Dates, on one uniform time scale (the configuration's is TDB): no leap seconds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace astroid {

/// Modified Julian Date of a proleptic Gregorian date and time, ISO 8601 extended format.
///
/// Accepts "2027-01-01", "2027-01-01T06:30", "2027-01-01T06:30:15" and "…15.25", years 0001 to 9999; the time scale
/// of the result is that of the text. A zone ("Z", "+01:00") or a second 60 is refused: uniform scales have neither.
///
/// @returns   MJD in days, or nothing where the text is no such date.
/// @accuracy  rounding of the double only: 1 µs in this century (test: Calendar.*).
[[nodiscard]] std::optional<double> mjd_from_iso8601(std::string_view text);

/// The inverse: "2027-01-01T06:30:15.250" for `decimals` = 3, rounded to the nearest.
///
/// @param mjd       days, years 0001 to 9999; others throw BugError.
/// @param decimals  of the seconds, 0 to 9.
[[nodiscard]] std::string iso8601_from_mjd(double mjd, int decimals);

}  // namespace astroid
