#include "astroid/core/random.hpp"

#include "philox.hpp"

namespace astroid {

namespace {

/// A bijection of 64-bit numbers that changes half of the bits when one changes (SplitMix64's finaliser).
std::uint64_t scramble(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

/// Odd, closest to 2^64 / golden ratio: keeps the all-zero state from being a fixed point.
constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15U;

std::uint64_t mix(std::uint64_t state, std::uint64_t field) {
  return scramble((state ^ field) + kGoldenGamma);
}

}  // namespace

RandomStream make_stream(std::uint64_t seed, StreamId effect, std::uint32_t camera, std::uint32_t detector) {
  std::uint64_t state = mix(0U, seed);
  state = mix(state, static_cast<std::uint32_t>(effect));
  state = mix(state, camera);
  state = mix(state, detector);
  return {{static_cast<std::uint32_t>(state), static_cast<std::uint32_t>(state >> 32U)}};
}

RandomWords philox4x32(const RandomStream& stream, const RandomWords& counter) {
  return philox_words(stream, counter);
}

}  // namespace astroid
