#include "astroid/catalogues/star_catalogue.hpp"

namespace astroid {

std::uint64_t star_hash(const std::string& id) {
  // FNV-1a: fixed for ever, since it addresses random draws.
  constexpr std::uint64_t kOffsetBasis = 14695981039346656037ULL;
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  std::uint64_t hash = kOffsetBasis;
  for (const char c : id) {
    hash ^= static_cast<unsigned char>(c);
    hash *= kPrime;
  }
  return hash;
}

}  // namespace astroid
