// Philox4x32-10 inlined into the loops over pixels.
#pragma once

#include <Random123/philox.h>

#undef philox4x32  // a macro of Random123, the name of our function

#include "astroid/core/random.hpp"

namespace astroid {

/// Salmon et al. 2011: the number the authors recommend ("Crush-resistant" from 7).
inline constexpr unsigned kPhiloxRounds = 10;

inline RandomWords philox_words(const RandomStream& stream, const RandomWords& counter) {
  const philox4x32_ctr_t words =
      philox4x32_R(kPhiloxRounds, philox4x32_ctr_t{{counter[0], counter[1], counter[2], counter[3]}},
                   philox4x32_key_t{{stream.key[0], stream.key[1]}});
  return {words.v[0], words.v[1], words.v[2], words.v[3]};
}

}  // namespace astroid
