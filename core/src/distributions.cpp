#include "astroid/core/distributions.hpp"

#include "normal_quantile.hpp"
#include "philox.hpp"

namespace astroid {

namespace {

constexpr unsigned kWordBits = 32;
constexpr unsigned kHalfWordBits = 16;

std::uint64_t join(std::uint32_t high, std::uint32_t low) {
  return std::uint64_t{high} << kWordBits | low;
}

std::uint32_t join_halves(std::uint16_t read, std::uint16_t draw) {
  return std::uint32_t{read} << kHalfWordBits | draw;
}

RandomWords source_words(const RandomStream& stream, const SourceAddress& address) {
  return philox_words(stream,
                      {static_cast<std::uint32_t>(address.hash), static_cast<std::uint32_t>(address.hash >> kWordBits),
                       address.exposure, join_halves(address.read, address.draw)});
}

RandomWords step_words(const RandomStream& stream, const StepAddress& address) {
  return philox_words(stream, {static_cast<std::uint32_t>(address.step),
                               static_cast<std::uint32_t>(address.step >> kWordBits), address.axis, address.draw});
}

}  // namespace

double standard_normal(std::uint32_t word) {
  return normal::quantile(word);
}
double standard_normal(std::uint64_t word) {
  return normal::quantile(word);
}

double uniform_for_source(const RandomStream& stream, const SourceAddress& address) {
  const RandomWords words = source_words(stream, address);
  return uniform_from(join(words[0], words[1]));
}

double normal_for_source(const RandomStream& stream, const SourceAddress& address) {
  const RandomWords words = source_words(stream, address);
  return standard_normal(join(words[0], words[1]));
}

double poisson_for_source(const RandomStream& stream, const SourceAddress& address, double mean) {
  const RandomWords words = source_words(stream, address);
  return poisson_quantile(mean, words[0], [&words] { return words[1]; });
}

double uniform_at_step(const RandomStream& stream, const StepAddress& address) {
  const RandomWords words = step_words(stream, address);
  return uniform_from(join(words[0], words[1]));
}

double normal_at_step(const RandomStream& stream, const StepAddress& address) {
  const RandomWords words = step_words(stream, address);
  return standard_normal(join(words[0], words[1]));
}

double poisson_at_step(const RandomStream& stream, const StepAddress& address, double mean) {
  const RandomWords words = step_words(stream, address);
  return poisson_quantile(mean, words[0], [&words] { return words[1]; });
}

}  // namespace astroid
