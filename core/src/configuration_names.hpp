// Suggestions for names that do not exist.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astroid::configuration {

/// Fewest insertions, deletions, substitutions and swaps of neighbours that turn one word into the other,
/// regardless of case (optimal string alignment).
std::size_t damerau_levenshtein(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, the first of equals; empty where none is near enough to be meant.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace astroid::configuration
