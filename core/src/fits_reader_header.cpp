// Keywords of FITS headers.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fits_file.hpp"

namespace astroid {

namespace {

constexpr std::size_t kCardLength = 80;  // characters, FITS standard

// Nothing when a keyword is absent or has no value.
bool is_absent(int status) {
  return status == KEY_NO_EXIST || status == VALUE_UNDEFINED;
}

}  // namespace

std::optional<double> FitsReader::number(int unit, const std::string& key) const {
  state_->go_to(unit);
  double value = 0.0;
  const int status = state_->attempt(&ffgkyd, key.c_str(), &value, static_cast<char*>(nullptr));
  if (is_absent(status)) return std::nullopt;
  if (status != 0)
    throw state_->refuse(fmt::format("keyword {} of {} is not a number", key, state_->unit_text(unit)), "a number");
  return value;
}

std::optional<std::string> FitsReader::unit_of(int unit, const std::string& key) const {
  state_->go_to(unit);
  std::array<char, FLEN_COMMENT> value{};
  const int status = state_->attempt(&ffgunt, key.c_str(), value.data());
  if (status != 0 || value.front() == '\0') return std::nullopt;
  return std::string(value.data());
}

std::optional<std::int64_t> FitsReader::integer(int unit, const std::string& key) const {
  state_->go_to(unit);
  LONGLONG value = 0;
  double as_number = 0.0;
  int status = state_->attempt(&ffgkyjj, key.c_str(), &value, static_cast<char*>(nullptr));
  if (is_absent(status)) return std::nullopt;
  // CFITSIO cuts off the fraction without a word.
  if (status == 0) status = state_->attempt(&ffgkyd, key.c_str(), &as_number, static_cast<char*>(nullptr));
  if (status != 0 || as_number != static_cast<double>(value)) {
    throw state_->refuse(fmt::format("keyword {} of {} is not a whole number", key, state_->unit_text(unit)),
                         "a whole number");
  }
  return value;
}

std::optional<bool> FitsReader::flag(int unit, const std::string& key) const {
  state_->go_to(unit);
  int value = 0;
  const int status = state_->attempt(&ffgkyl, key.c_str(), &value, static_cast<char*>(nullptr));
  if (is_absent(status)) return std::nullopt;
  if (status != 0)
    throw state_->refuse(fmt::format("keyword {} of {} is not T or F", key, state_->unit_text(unit)), "T or F");
  return value != 0;
}

std::optional<std::string> FitsReader::text(int unit, const std::string& key) const {
  state_->go_to(unit);
  char* value = nullptr;
  const int status = state_->attempt(&ffgkls, key.c_str(), &value, static_cast<char*>(nullptr));
  std::optional<std::string> result;
  if (status == 0 && value != nullptr) result = value;
  int ignored = 0;
  if (value != nullptr) fits_free_memory(value, &ignored);
  if (status != 0 && !is_absent(status)) {
    throw state_->refuse(fmt::format("keyword {} of {} is not a text", key, state_->unit_text(unit)),
                         "a text in quotes");
  }
  return result;
}

std::string FitsReader::header_text(int unit) const {
  state_->go_to(unit);
  char* header = nullptr;
  int cards = 0;
  state_->call(&ffhdr2str, 0, static_cast<char**>(nullptr), 0, &header, &cards);
  std::string result = header;
  int ignored = 0;
  fits_free_memory(header, &ignored);
  return result;
}

std::vector<std::string> FitsReader::history(int unit) const {
  constexpr std::string_view kKey = "HISTORY ";
  const std::string header = header_text(unit);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at + kCardLength <= header.size(); at += kCardLength) {
    if (header.compare(at, kKey.size(), kKey) != 0) continue;
    std::string line = header.substr(at + kKey.size(), kCardLength - kKey.size());
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace astroid
