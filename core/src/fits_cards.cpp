#include "fits_cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "astroid/core/csv.hpp"
#include "astroid/core/error.hpp"
#include "cfitsio_call.hpp"

namespace astroid {

namespace {

constexpr std::size_t kCardWidth = 80;      // characters, FITS standard
constexpr std::size_t kLongestKey = 8;      // characters, FITS standard
constexpr std::size_t kLongestText = 68;    // characters of a text that fits on one card
constexpr std::size_t kChecksumWidth = 16;  // characters, FITS standard

// "15" -> "15.", "1e+22" -> "1E+22": shortest text that FITS takes for a floating-point number.
std::string fits_text(double value) {
  std::string text = shortest_text(value);
  std::replace(text.begin(), text.end(), 'e', 'E');
  if (text.find_first_of(".E") == std::string::npos) text += '.';
  return text;
}

std::string now() {
  // https://reproducible-builds.org/specs/source-date-epoch: files made twice are the same to the byte.
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t time =
      epoch != nullptr ? static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)) : std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

// 'It''s' with blanks up to the eighth character, as the standard wants texts.
std::string quoted(const std::string& text) {
  std::string value;
  for (const char c : text) value.append(c == '\'' ? 2 : 1, c);
  return fmt::format("'{:<8}'", value);
}

// The value of a card as it stands in a header. Not by CFITSIO, whose doubles have 15 digits or a fixed number of them.
std::string value_text(const FitsValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(printable_ascii(*text));
  if (const auto* flag = std::get_if<bool>(&value)) return fmt::format("{:>20}", *flag ? 'T' : 'F');
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{:>20}", *integer);
  const double number = std::get<double>(value);
  return std::isfinite(number) ? fmt::format("{:>20}", fits_text(number)) : quoted(shortest_text(number));
}

bool is_long(const FitsCard& card) {
  const auto* text = std::get_if<std::string>(&card.value);
  return text != nullptr && text->size() > kLongestText;
}

void check_key(const std::string& key) {
  if (key.empty() || key.size() > kLongestKey) throw BugError("FITS keyword '" + key + "'");
}

}  // namespace

std::string printable_ascii(std::string_view text) {
  std::string result(text);
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

std::string fits_card_line(const FitsCard& card) {
  check_key(card.key);
  std::array<char, FLEN_CARD> line{};
  std::string value = value_text(card.value);
  int status = 0;
  if (!is_long(card))
    fits_make_key(card.key.c_str(), value.data(), printable_ascii(card.comment).c_str(), line.data(), &status);
  if (is_long(card) || status != 0) throw BugError("FITS card of " + card.key + " does not fit on one line");
  return fmt::format("{:<{}}", line.data(), kCardWidth);
}

void replace_fits_card(std::string& header, const FitsCard& card) {
  const std::string line = fits_card_line(card);
  const std::string_view key = std::string_view(line).substr(0, kLongestKey);
  for (std::size_t at = 0; at < header.size(); at += kCardWidth) {
    if (header.compare(at, key.size(), key) != 0) continue;
    header.replace(at, kCardWidth, line);
    return;
  }
  throw BugError("FITS header without a card of " + card.key);
}

FitsCard fits_date_card() {
  return {"DATE", now(), "[UTC] when this unit was written"};
}

void set_fits_card(fitsfile* file, const FitsCard& card, int* status) {
  check_key(card.key);
  if (!is_long(card)) {
    ffucrd(file, card.key.c_str(), fits_card_line(card).c_str(), status);
    return;
  }
  ffplsw(file, status);  // announces texts of several cards, once
  ffukls(file, card.key.c_str(), printable_ascii(std::get<std::string>(card.value)).c_str(),
         printable_ascii(card.comment).c_str(), status);
}

void add_fits_history(fitsfile* file, std::string_view line, int* status) {
  ffphis(file, printable_ascii(line).c_str(), status);
}

void set_fits_unit_cards(fitsfile* file, const std::string& name, int* status) {
  // All of them now, for a header must not grow once data follow it.
  if (!name.empty()) set_fits_card(file, {"EXTNAME", name, "name of this unit"}, status);
  set_fits_card(file, fits_date_card(), status);
  set_fits_card(file, {"CHECKSUM", std::string(kChecksumWidth, '0'), "of the unit"}, status);
  set_fits_card(file, {"DATASUM", "0", "of the data"}, status);
}

}  // namespace astroid
