#include "astroid/core/calendar.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "astroid/core/error.hpp"
#include "astroid/core/units.hpp"

namespace astroid {

namespace {

constexpr double kMjdOfUnixEpoch = 40587.0;  // 1970-01-01T00:00, days
constexpr int kSecondsPerHour = 3600;
constexpr int kSecondsPerMinute = 60;

/// Takes exactly `digits` decimal digits from the front of `text`.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<std::chrono::sys_days> take_date(std::string_view& text) {
  const auto year = take_digits(text, 4);
  if (!year || *year == 0 || !take(text, '-')) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date);
}

/// Seconds since midnight from "hh:mm", "hh:mm:ss" or "hh:mm:ss.fff", the whole rest of `text`.
std::optional<double> take_time(std::string_view& text) {
  constexpr int kHours = 24;
  const auto hour = take_digits(text, 2);
  if (!hour || *hour >= kHours || !take(text, ':')) return std::nullopt;
  const auto minute = take_digits(text, 2);
  if (!minute || *minute >= kSecondsPerMinute) return std::nullopt;
  const int whole = *hour * kSecondsPerHour + *minute * kSecondsPerMinute;
  if (text.empty()) return whole;
  if (!take(text, ':')) return std::nullopt;
  const std::string_view seconds = text;
  if (const auto second = take_digits(text, 2); !second || *second >= kSecondsPerMinute) return std::nullopt;
  if (!text.empty()) {
    if (!take(text, '.') || text.empty()) return std::nullopt;
    if (text.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  }
  double value = 0.0;
  std::from_chars(seconds.data(), seconds.data() + seconds.size(), value);
  return whole + value;
}

}  // namespace

std::optional<double> mjd_from_iso8601(std::string_view text) {
  const auto date = take_date(text);
  if (!date) return std::nullopt;
  const double day = kMjdOfUnixEpoch + static_cast<double>(date->time_since_epoch().count());
  if (text.empty()) return day;
  if (!take(text, 'T')) return std::nullopt;
  const auto seconds = take_time(text);
  if (!seconds) return std::nullopt;
  return day + *seconds / kSecondsPerDay;
}

std::string iso8601_from_mjd(double mjd, int decimals) {
  constexpr double kFirst = -678575.0;  // 0001-01-01
  constexpr double kEnd = 2973484.0;    // 10000-01-01
  ASTROID_CHECK_LE(kFirst, mjd);
  ASTROID_CHECK_LT(mjd, kEnd);
  ASTROID_CHECK_LE(0, decimals);
  ASTROID_CHECK_LE(decimals, 9);
  std::int64_t ticks_per_second = 1;
  for (int i = 0; i < decimals; ++i) ticks_per_second *= 10;
  const auto ticks_per_day = static_cast<std::int64_t>(kSecondsPerDay) * ticks_per_second;
  double day = std::floor(mjd);
  auto ticks = static_cast<std::int64_t>(std::llround((mjd - day) * static_cast<double>(ticks_per_day)));
  if (ticks == ticks_per_day) {
    day += 1.0;
    ticks = 0;
  }
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::days(static_cast<int>(day - kMjdOfUnixEpoch)))};
  const std::int64_t second_of_day = ticks / ticks_per_second;
  std::string text =
      fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                  second_of_day / kSecondsPerHour, second_of_day / kSecondsPerMinute % 60, second_of_day % 60);
  if (decimals > 0) text += fmt::format(".{:0{}}", ticks % ticks_per_second, decimals);
  return text;
}

}  // namespace astroid
