#include "astroid/core/calendar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "astroid/core/error.hpp"

namespace astroid {
namespace {

constexpr double kSecond = 1.0 / 86400.0;

// Dates with their MJD: the definitions of MJD 0, of J2000.0 (JD 2451545.0) and of the Unix epoch, and leap years.
TEST(Calendar, KnowsTheDatesThatDefineIt) {
  EXPECT_EQ(mjd_from_iso8601("1858-11-17T00:00:00"), 0.0);
  EXPECT_EQ(mjd_from_iso8601("2000-01-01T12:00:00"), 51544.5);
  EXPECT_EQ(mjd_from_iso8601("1970-01-01"), 40587.0);
  EXPECT_EQ(mjd_from_iso8601("1957-10-04T00:00"), 36115.0);  // Sputnik 1, JD 2436115.5
  EXPECT_EQ(mjd_from_iso8601("1995-10-10T00:00:00"), 50000.0);
  EXPECT_EQ(mjd_from_iso8601("2023-02-25T00:00:00"), 60000.0);
  EXPECT_EQ(mjd_from_iso8601("2027-01-01T00:00:00"), 61406.0);
}

TEST(Calendar, CountsLeapDays) {
  EXPECT_EQ(*mjd_from_iso8601("2000-03-01") - *mjd_from_iso8601("2000-02-28"), 2.0);
  EXPECT_EQ(*mjd_from_iso8601("1900-03-01") - *mjd_from_iso8601("1900-02-28"), 1.0);
  EXPECT_EQ(mjd_from_iso8601("1900-02-29"), std::nullopt);
  EXPECT_TRUE(mjd_from_iso8601("2028-02-29").has_value());
}

TEST(Calendar, ReadsFractionsOfASecond) {
  EXPECT_NEAR(*mjd_from_iso8601("2027-01-01T00:00:01") - 61406.0, kSecond, 1e-11);
  EXPECT_NEAR(*mjd_from_iso8601("2027-01-01T23:59:59.5") - 61406.0, 1.0 - 0.5 * kSecond, 1e-11);
  EXPECT_EQ(mjd_from_iso8601("2027-01-01T06:00:00.000"), 61406.25);
}

TEST(Calendar, RefusesWhatIsNoDate) {
  for (const char* text : {"",
                           "2027",
                           "2027-1-1",
                           "2027-13-01",
                           "2027-00-01",
                           "2027-04-31",
                           "0000-01-01",
                           "2027-01-01T",
                           "2027-01-01T24:00",
                           "2027-01-01T12",
                           "2027-01-01T12:60",
                           "2027-01-01T12:00:60",
                           "2027-01-01T12:00:00.",
                           "2027-01-01T12:00:00Z",
                           "2027-01-01T12:00:00+01:00",
                           "2027-01-01 12:00:00",
                           " 2027-01-01",
                           "20270101",
                           "-2027-01-01",
                           "2027-01-01T12:00:00.1e3"}) {
    EXPECT_EQ(mjd_from_iso8601(text), std::nullopt) << text;
  }
}

TEST(Calendar, WritesWhatItReads) {
  for (const char* text : {"1858-11-17T00:00:00.000", "1999-12-31T23:59:59.999", "2027-01-01T00:00:12.500",
                           "2028-02-29T12:34:56.789", "0001-01-01T00:00:00.000"}) {
    EXPECT_EQ(iso8601_from_mjd(*mjd_from_iso8601(text), 3), text);
  }
  EXPECT_EQ(iso8601_from_mjd(51544.5, 0), "2000-01-01T12:00:00");
}

TEST(Calendar, CarriesARoundedSecondIntoTheNextDay) {
  EXPECT_EQ(iso8601_from_mjd(std::nextafter(61406.0, 0.0), 0), "2027-01-01T00:00:00");
}

TEST(Calendar, RefusesYearsItCannotWrite) {
  EXPECT_THROW((void)iso8601_from_mjd(1e9, 0), BugError);
}

}  // namespace
}  // namespace astroid
