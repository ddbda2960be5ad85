// Addressable random numbers: every draw has an address, so it does not depend on what else is drawn, where or when.
//
// Philox4x32-10 (Salmon et al. 2011; Random123). The layout, which is a promise (docs/random-numbers.md):
//   key      64 bits  mix(seed, effect, camera, detector); attitude effects use camera = detector = 0
//   pixels   counter {x >> 2, y, exposure, read << 16 | draw}, word x & 3
//   sources  counter {hash low, hash high, exposure, read << 16 | draw}
//   steps    counter {step low, step high, axis, draw}
// Negative x and y (prescan, overscan) enter as two's complement. Effects of scope `static` use exposure 0.
#pragma once

#include <array>
#include <cstdint>

namespace astroid {

/// Random stream numbers of effects; written into the address, so never changed and never reused.
enum class StreamId : std::uint32_t {};

/// One stream: the key, built once per effect, camera and detector.
struct RandomStream {
  std::array<std::uint32_t, 2> key{};
};

using RandomWords = std::array<std::uint32_t, 4>;

/// @source Steele2014 (SplitMix64 finaliser), applied to each field in turn; exact definition: docs/random-numbers.md.
RandomStream make_stream(std::uint64_t seed, StreamId effect, std::uint32_t camera, std::uint32_t detector);

/// The four words at a counter. @source Salmon2011; known-answer vectors of Random123 are tests.
RandomWords philox4x32(const RandomStream& stream, const RandomWords& counter);

}  // namespace astroid
