// One line of a FITS header.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace astroid {

using FitsValue = std::variant<bool, std::int64_t, double, std::string>;

/// Keyword (at most 8 characters of A-Z, 0-9, - and _), value and comment. A double is written so that it reads back
/// exactly; NaN and infinities, which FITS headers cannot hold, are written as the text "nan", "inf", "-inf".
struct FitsCard {
  std::string key{};
  FitsValue value{};
  std::string comment{};

  FitsCard(std::string k, const char* v, std::string c = {})
      : key(std::move(k)), value(std::string(v)), comment(std::move(c)) {}
  FitsCard(std::string k, std::string v, std::string c = {})
      : key(std::move(k)), value(std::move(v)), comment(std::move(c)) {}
  FitsCard(std::string k, double v, std::string c = {}) : key(std::move(k)), value(v), comment(std::move(c)) {}
  FitsCard(std::string k, bool v, std::string c = {}) : key(std::move(k)), value(v), comment(std::move(c)) {}
  FitsCard(std::string k, int v, std::string c = {})
      : key(std::move(k)), value(std::int64_t{v}), comment(std::move(c)) {}
  FitsCard(std::string k, std::int64_t v, std::string c = {}) : key(std::move(k)), value(v), comment(std::move(c)) {}
};

}  // namespace astroid
