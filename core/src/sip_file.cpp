#include <fmt/format.h>

#include <string>
#include <vector>

#include "astroid/core/distortion.hpp"
#include "astroid/core/fits_reader.hpp"

namespace astroid {

SipPolynomial read_sip_polynomial(const std::string& path) {
  constexpr int kPrimary = 1;
  const FitsReader fits(path);
  std::vector<Problem> problems;
  const auto refuse = [&](const std::string& key, const std::string& value, const char* expected, const char* message) {
    problems.push_back({.file = path, .parameter = key, .value = value, .expected = expected, .message = message});
  };
  int order = 0;
  for (const char* key : {"A_ORDER", "B_ORDER"}) {
    const auto value = fits.integer(kPrimary, key);
    if (!value) {
      refuse(key, "", "an order from 2 to 9 in the primary header", "the keyword is missing");
    } else if (*value < 2 || *value > SipPolynomial::kHighestOrder) {
      refuse(key, fmt::format("{}", *value), "an order from 2 to 9", "such a polynomial is no SIP distortion");
    } else {
      order = std::max(order, static_cast<int>(*value));
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  SipPolynomial polynomial(order);
  for (int i = 0; i <= order; ++i) {
    for (int j = 0; i + j <= order; ++j) {
      for (const char side : {'A', 'B'}) {
        const std::string key = fmt::format("{}_{}_{}", side, i, j);
        const double value = fits.number(kPrimary, key).value_or(0.0);
        if (i + j < 2 && value != 0.0) {
          refuse(key, fmt::format("{}", value), "terms of second and higher order only",
                 "shifts and scales belong to the pointing and the pixel scale");
        } else {
          (side == 'A' ? polynomial.a : polynomial.b)[polynomial.index(i, j)] = value;
        }
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return polynomial;
}

}  // namespace astroid
