// The kernels of pixel_noise.hpp pixel by pixel: the same operations in the same order, so the same bits.
#include "vector/pixel_noise_reference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "astroid/core/digitise.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/pixel_noise.hpp"
#include "philox.hpp"
#include "poisson_quantile.hpp"
#include "vector/pixel_counter.hpp"
#include "vector/pixel_noise_fits.hpp"

namespace astroid::reference {

namespace {

/// Even and odd powers apart, as in the kernels.
template <std::size_t N>
float polynomial(float x, const std::array<float, N>& coefficient) {
  const float square = x * x;
  std::array<float, 2> sum{};  // of even powers, of odd ones
  for (std::size_t parity = 0; parity < 2; ++parity) {
    std::size_t i = (N - 1) % 2 == parity ? N - 1 : N - 2;
    sum[parity] = coefficient[i];
    while (i >= 2) {
      i -= 2;
      sum[parity] = sum[parity] * square + coefficient[i];
    }
  }
  return sum[0] + sum[1] * x;
}

/// -ln(y / 2^62) for 0 < y <= 2^62.
float minus_log(float y) {
  const std::uint32_t shifted = std::bit_cast<std::uint32_t>(y) - fits::kScaledSqrtHalfBits;
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(shifted) >> fits::kMantissaBits);
  const float g = std::bit_cast<float>((shifted & fits::kMantissaMask) + fits::kSqrtHalfBits) - 1.0F;
  return exponent * -fits::kLn2 + (g * g * polynomial(g, fits::kMinusLog) - g);
}

/// e^-x for 0 <= x < 80.
float exp_of_minus(float x) {
  constexpr float kRounder = 0x1.8p23F;  // added, it leaves the nearest integer in the lowest bits
  const float shifted = x * -fits::kLog2E + kRounder;
  const float k = shifted - kRounder;
  const float r = -x - k * fits::kLn2;
  const std::uint32_t scale =
      (std::bit_cast<std::uint32_t>(shifted) << fits::kMantissaBits) + std::bit_cast<std::uint32_t>(1.0F);
  return polynomial(r, fits::kExp) * std::bit_cast<float>(scale);
}

constexpr std::uint32_t kSign = 0x80000000U;

double poisson_of_small_mean(float mean, std::uint32_t word) {
  const float u = (static_cast<float>(static_cast<std::int32_t>(word >> 1U)) + 0.25F) * (1.0F / fits::kUnits);
  float term = exp_of_minus(mean);
  float sum = term;
  float n = 0.0F;
  bool near = false;
  for (int step = 1; step <= fits::kMostSteps; ++step) {
    near = near || std::fabs(u - sum) <= fits::kErrorOfSum;
    if (!(u >= sum + fits::kErrorOfSum)) break;
    n = static_cast<float>(step);
    term = term * (mean * (1.0F / static_cast<float>(step)));
    sum = sum + term;
    near = near || step == fits::kMostSteps;
  }
  return near ? poisson::kUndecided : static_cast<double>(n);
}

}  // namespace

NormalOfWord normal_of_word(std::uint32_t word) {
  const auto centred = static_cast<std::int32_t>(word ^ kSign);
  const std::int32_t beyond = std::numeric_limits<std::int32_t>::max() ^ centred ^ (centred >> 31);
  const float tail = static_cast<float>(beyond) + 0.5F;
  const float w = minus_log(tail * (2.0F * fits::kUnits - tail));
  const float p = w < fits::kTail ? polynomial(w - fits::kCentre, fits::kCentral)
                                  : polynomial(std::sqrt(w) - fits::kTailCentre, fits::kFar);
  return {std::copysign((fits::kUnits - tail) * p, std::bit_cast<float>(centred)), tail};
}

float pixel_normal(std::uint32_t word) {
  return normal_of_word(word).z;
}

ContinuousCount continuous_count(double mean, std::uint32_t word) {
  const auto [w, tail] = normal_of_word(word);
  const auto single = static_cast<float>(mean);
  const auto fraction = static_cast<float>(mean - std::floor(mean));
  const float root = std::sqrt(single);
  const float inverse = 1.0F / single;
  const float first = root * w;
  const float s = first * inverse;
  const float second = w * w * polynomial(s, fits::kA);
  const float third = polynomial(s, fits::kC0) + inverse * polynomial(s, fits::kC1);
  return {.offset = fraction + (first + (second + third)),
          .room = fits::kRoom - inverse * fits::kErrorPerMean -
                  root * (std::fabs(w) * fits::kErrorOfNormal + fits::kErrorOfCentre),
          .in_range = s > fits::kLowestS && s < fits::kHighestS,
          .root = root,
          .tail = tail};
}

double poisson_of_word(double mean, std::uint32_t word) {
  const auto single = static_cast<float>(mean);
  if (std::signbit(single) || std::isnan(single)) return poisson::kUndecided;
  if (single < fits::kSmallMean) return poisson_of_small_mean(single, word);
  const ContinuousCount x = continuous_count(mean, word);
  const float steps = std::nearbyint(x.offset);
  // As in poisson::quantile_of_normal: the low word moves x by less than root / tail.
  const bool decided = x.in_range && (x.room - std::fabs(x.offset - steps)) * x.tail > x.root;
  return decided ? std::floor(mean) + static_cast<double>(steps) : poisson::kUndecided;
}

namespace {

/// Calls function(i, address) for every pixel.
template <class Function>
void for_each_pixel(const PixelPlaces& pixels, Function&& function) {
  std::size_t i = 0;
  for (const Rectangle& area : pixels.areas)
    for (int y = area.y0; y < area.y1(); ++y)
      for (int column = 0; column < area.nx; ++column) function(i++, address_of(pixels, area.x0 + column, y));
}

}  // namespace

void pixel_words(const RandomStream& stream, const PixelPlaces& pixels, std::span<std::uint32_t> words) {
  check_size(pixels, words.size());
  for_each_pixel(pixels, [&](std::size_t i, const PixelAddress& at) { words[i] = pixel_word(stream, at); });
}

void pixel_uniforms(const RandomStream& stream, const PixelPlaces& pixels, std::span<double> uniforms) {
  check_size(pixels, uniforms.size());
  for_each_pixel(pixels,
                 [&](std::size_t i, const PixelAddress& at) { uniforms[i] = uniform_from(pixel_word(stream, at)); });
}

void pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, std::span<float> normals) {
  check_size(pixels, normals.size());
  for_each_pixel(pixels,
                 [&](std::size_t i, const PixelAddress& at) { normals[i] = pixel_normal(pixel_word(stream, at)); });
}

void add_pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, double rms, std::span<double> values) {
  check_size(pixels, values.size());
  for_each_pixel(pixels, [&](std::size_t i, const PixelAddress& at) {
    values[i] += rms * static_cast<double>(pixel_normal(pixel_word(stream, at)));
  });
}

void pixel_poisson(const RandomStream& stream, const PixelPlaces& pixels, std::span<const double> mean,
                   std::span<double> counts) {
  check_poisson(pixels, mean, counts);
  for_each_pixel(pixels, [&](std::size_t i, const PixelAddress& at) {
    const std::uint32_t word = pixel_word(stream, at);
    const double count = poisson_of_word(mean[i], word);
    counts[i] = count >= 0.0 ? count : poisson_at_pixel(stream, at, mean[i], word);
  });
}

std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags) {
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::uint8_t flag = 0;
    digital[i] = digitise(counts[i], top, flag);
    flags[i] = static_cast<std::uint8_t>(flags[i] | flag);
    clipped += (flag & pixel_flag::kAdcSaturated) != 0 ? 1U : 0U;
  }
  return clipped;
}

}  // namespace astroid::reference
