#include "configuration_names.hpp"

#include <algorithm>

namespace astroid::configuration {

namespace {

constexpr std::size_t kLongestName = 100;  // longer ones are noise, not misspelt names

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::size_t damerau_levenshtein(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, last[j - 1] + (same ? 0U : 1U)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) current[j] = std::min(current[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, current);
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.size() > kLongestName) return {};
  std::string best;
  std::size_t best_distance = kLongestName;
  for (const std::string& candidate : candidates) {
    // One letter in three may be wrong, one in a word of two; a word that is the beginning of a longer one is near.
    const std::size_t shorter = std::min(name.size(), candidate.size());
    const std::size_t allowed = shorter == 2 ? 1 : (shorter + 1) / 3;
    const std::size_t distance = damerau_levenshtein(name, candidate);
    const bool is_beginning = name.size() >= 3 && candidate.size() > name.size() &&
                              equal_ignoring_case(name, std::string_view(candidate).substr(0, name.size()));
    if ((distance <= allowed || is_beginning) && distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace astroid::configuration
