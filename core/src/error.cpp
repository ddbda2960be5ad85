#include "astroid/core/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace astroid {

namespace {

std::string summary(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

}  // namespace

std::string Problem::text() const {
  std::string out;
  if (!file.empty()) out += line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
  if (!parameter.empty())
    out += value.empty() ? fmt::format("{}: ", parameter) : fmt::format("{} = {}: ", parameter, value);
  out += message;
  if (!expected.empty()) out += fmt::format("; expected {}", expected);
  if (!suggestion.empty()) out += fmt::format("; {}", suggestion);
  return out;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(summary(problems)), problems_(std::move(problems)) {}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

EnvironmentError::EnvironmentError(const std::string& path, const std::string& cause)
    : std::runtime_error(fmt::format("{}: {}", path, cause)) {}

void detail::check_failed(const char* file, int line, const char* expression, double left, double right) {
  throw BugError(fmt::format("{}:{}: check failed: {} (left {}, right {})", file, line, expression, left, right));
}

}  // namespace astroid
