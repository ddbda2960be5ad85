// The kernels of pixel_noise.hpp, compiled for every instruction set and chosen when the program starts.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vector/pixel_noise.cpp"
#include "astroid/core/pixel_noise.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "astroid/core/digitise.hpp"
#include "vector/draws-inl.hpp"
#include "vector/pixel_counter.hpp"
#include "vector/word_blocks-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace astroid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kSingles = HWY_LANES(float);
constexpr std::size_t kDoubles = HWY_LANES(double);

void words_kernel(const RandomStream& stream, const PixelPlaces& pixels, std::uint32_t* out) {
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) std::copy_n(blocks.words(), blocks.size(), out + blocks.first());
}

HWY_INLINE Double uniforms(hn::Vec<hn::Half<Unsigned>> word) {
  const Doubles d;
  const hn::Half<Integers> di;
  const hn::Half<Unsigned> du;
  constexpr double kHalfRange = 0x1p31 + 0.5;
  const auto centred = hn::BitCast(di, hn::Xor(word, hn::Set(du, 0x80000000U)));
  return hn::Mul(hn::Add(hn::PromoteTo(d, centred), hn::Set(d, kHalfRange)), hn::Set(d, 0x1p-32));
}

void uniforms_kernel(const RandomStream& stream, const PixelPlaces& pixels, double* out) {
  const Doubles d;
  const hn::Half<Unsigned> du;
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    alignas(64) std::array<double, WordBlocks::kBlock + WordBlocks::kWidestVector> values;
    for (std::size_t k = 0; k < blocks.size(); k += kDoubles)
      hn::StoreU(uniforms(hn::LoadU(du, blocks.words() + k)), d, values.data() + k);
    std::copy_n(values.begin(), blocks.size(), out + blocks.first());
  }
}

void normals_kernel(const RandomStream& stream, const PixelPlaces& pixels, float* out) {
  const Singles d;
  const Unsigned du;
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kWidestVector> values;
    for (std::size_t k = 0; k < blocks.size(); k += kSingles)
      hn::StoreU(normals_of_words(hn::LoadU(du, blocks.words() + k)).z, d, values.data() + k);
    std::copy_n(values.begin(), blocks.size(), out + blocks.first());
  }
}

HWY_INLINE void add_normals(const std::uint32_t* words, double rms, double* values) {
  const Doubles d;
  const Unsigned du;
  const auto [lower, upper] = promote(normals_of_words(hn::LoadU(du, words)).z);
  const Double scale = hn::Set(d, rms);
  hn::StoreU(hn::Add(hn::LoadU(d, values), hn::Mul(scale, lower)), d, values);
  hn::StoreU(hn::Add(hn::LoadU(d, values + kDoubles), hn::Mul(scale, upper)), d, values + kDoubles);
}

void add_normals_kernel(const RandomStream& stream, const PixelPlaces& pixels, double rms, double* values) {
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    double* const block = values + blocks.first();
    std::size_t k = 0;
    for (; k + kSingles <= blocks.size(); k += kSingles) add_normals(blocks.words() + k, rms, block + k);
    if (k == blocks.size()) continue;
    std::array<double, kSingles> rest{};
    std::copy(block + k, block + blocks.size(), rest.begin());
    add_normals(blocks.words() + k, rms, rest.data());
    std::copy_n(rest.begin(), blocks.size() - k, block + k);
  }
}

/// Normals of a block of words, with what poisson_of_large_means() wants to know of them. A pass of its own: the chains
/// of dependent operations are long, and the processor overlaps more of shorter loops.
struct NormalBlock {
  HWY_INLINE NormalBlock(const std::uint32_t* words, std::size_t size) {
    const Singles d;
    for (std::size_t k = 0; k < size; k += kSingles) {
      const Normals normals = normals_of_words(hn::LoadU(Unsigned(), words + k));
      hn::Store(normals.z, d, z.data() + k);
      hn::Store(normals.tail, d, tail.data() + k);
    }
  }
  alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kWidestVector> z;
  alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kWidestVector> tail;
};

/// What poisson() looks at for one vector of pixels.
struct Means {
  Single mean;
  Single fraction;
  Double whole_lower;
  Double whole_upper;
};

/// Counts of means that may be small: by adding probabilities.
struct SmallMeans {
  const std::uint32_t* words;
  HWY_INLINE Counts operator()(const Means& means, std::size_t k) const {
    const Singles d;
    const Integers di;
    const Single ten = hn::Set(d, fits::kSmallMean);
    Counts counts = poisson_of_small_means(hn::Min(means.mean, ten), hn::LoadU(Unsigned(), words + k));
    counts.steps = hn::Sub(counts.steps, demote(means.whole_lower, means.whole_upper));
    // No mean: the sign is set, or it is not a number.
    const auto positive = hn::RebindMask(d, hn::Gt(hn::BitCast(di, means.mean), hn::Set(di, -1)));
    counts.decided = hn::And(hn::And(counts.decided, positive), hn::Eq(means.mean, means.mean));
    return counts;
  }
};

/// Counts of means most of which are large: by the continuous quantile.
struct AnyMeans {
  const NormalBlock& normals;
  SmallMeans small;
  HWY_INLINE Counts operator()(const Means& means, std::size_t k) const {
    const Singles d;
    Counts counts = poisson_of_large_means(means.mean, means.fraction, hn::Load(d, normals.z.data() + k),
                                           hn::Load(d, normals.tail.data() + k));
    const auto large = hn::Ge(means.mean, hn::Set(d, fits::kSmallMean));
    if (HWY_LIKELY(hn::AllTrue(d, large))) return counts;
    const Counts of_small = small(means, k);
    counts.steps = hn::IfThenElse(large, counts.steps, of_small.steps);
    counts.decided = hn::Or(hn::And(large, counts.decided), hn::AndNot(large, of_small.decided));
    return counts;
  }
};

/// Counts of one vector of pixels, negative where they are undecided. @returns whether all are decided
template <class Method>
HWY_INLINE bool poisson(const Method& method, std::size_t k, const double* mean, double* counts) {
  const Doubles d;
  const Singles ds;
  const Double lower = hn::LoadU(d, mean);
  const Double upper = hn::LoadU(d, mean + kDoubles);
  const Double whole_lower = hn::Floor(lower);
  const Double whole_upper = hn::Floor(upper);
  const Counts result = method({.mean = demote(lower, upper),
                                .fraction = demote(hn::Sub(lower, whole_lower), hn::Sub(upper, whole_upper)),
                                .whole_lower = whole_lower,
                                .whole_upper = whole_upper},
                               k);
  constexpr float kNone = -std::numeric_limits<float>::infinity();
  const TwoDoubles steps = promote(hn::IfThenElse(result.decided, result.steps, hn::Set(ds, kNone)));
  hn::StoreU(hn::Add(whole_lower, steps.lower), d, counts);
  hn::StoreU(hn::Add(whole_upper, steps.upper), d, counts + kDoubles);
  return hn::AllTrue(ds, result.decided);
}

/// A whole block. @returns whether all are decided
template <class Method>
HWY_INLINE bool poisson_block(const Method& method, std::size_t size, const double* mean, double* counts) {
  bool decided = true;
  std::size_t k = 0;
  for (; k + kSingles <= size; k += kSingles) decided &= poisson(method, k, mean + k, counts + k);
  if (k == size) return decided;
  std::array<double, kSingles> rest_mean;
  std::array<double, kSingles> rest;
  rest_mean.fill(mean[k]);
  std::copy(mean + k, mean + size, rest_mean.begin());
  decided &= poisson(method, k, rest_mean.data(), rest.data());
  std::copy_n(rest.begin(), size - k, counts + k);
  return decided;
}

void poisson_kernel(const RandomStream& stream, const PixelPlaces& pixels, const double* mean, double* counts) {
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    const double* const block_mean = mean + blocks.first();
    double* const block = counts + blocks.first();
    const SmallMeans small{blocks.words()};
    bool any_large = false;
    for (std::size_t i = 0; i < blocks.size() && !any_large; ++i)
      any_large = block_mean[i] >= static_cast<double>(fits::kSmallMean);
    const bool decided = any_large ? poisson_block(AnyMeans{NormalBlock(blocks.words(), blocks.size()), small},
                                                   blocks.size(), block_mean, block)
                                   : poisson_block(small, blocks.size(), block_mean, block);
    if (HWY_LIKELY(decided)) continue;
    for (std::size_t i = 0; i < blocks.size(); ++i)
      if (!(block[i] >= 0.0))
        block[i] = poisson_at_pixel(stream, pixel_at(pixels, blocks.first() + i), block_mean[i], blocks.words()[i]);
  }
}

/// Flags the pixels outside of a mask. @returns how many they are
HWY_INLINE std::size_t flag_clipped(hn::Mask<Doubles> inside, std::uint8_t* flags) {
  const Doubles d;
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(d, inside, bits.data());
  std::size_t clipped = 0;
  for (std::uint32_t outside = ~std::uint32_t{bits[0]} & ((1U << kDoubles) - 1U); outside != 0;
       outside &= outside - 1U) {
    flags[hwy::Num0BitsBelowLS1Bit_Nonzero32(outside)] |= pixel_flag::kAdcSaturated;
    ++clipped;
  }
  return clipped;
}

std::size_t digitise_kernel(const double* counts, std::size_t size, double top, float* digital, std::uint8_t* flags) {
  const Doubles d;
  const Singles ds;
  const Double limit = hn::Set(d, top);
  const Double zero = hn::Zero(d);
  std::size_t clipped = 0;
  std::size_t i = 0;
  const auto one_by_one = [&](std::size_t end) {
    for (; i < end; ++i) {
      std::uint8_t flag = 0;
      digital[i] = digitise(counts[i], top, flag);
      flags[i] = static_cast<std::uint8_t>(flags[i] | flag);
      clipped += (flag & pixel_flag::kAdcSaturated) != 0 ? 1U : 0U;
    }
  };
  while (i + kSingles <= size) {
    const Double lower = hn::Add(hn::Round(hn::LoadU(d, counts + i)), zero);
    const Double upper = hn::Add(hn::Round(hn::LoadU(d, counts + i + kDoubles)), zero);
    const auto lower_inside = hn::And(hn::Lt(lower, limit), hn::Ge(lower, zero));
    const auto upper_inside = hn::And(hn::Lt(upper, limit), hn::Ge(upper, zero));
    if (HWY_LIKELY(hn::AllTrue(d, hn::And(lower_inside, upper_inside)))) {
      hn::StoreU(demote(lower, upper), ds, digital + i);
    } else if (hn::AllTrue(d, hn::And(hn::Eq(lower, lower), hn::Eq(upper, upper)))) {
      hn::StoreU(demote(hn::Min(hn::Max(lower, zero), limit), hn::Min(hn::Max(upper, zero), limit)), ds, digital + i);
      clipped += flag_clipped(lower_inside, flags + i) + flag_clipped(upper_inside, flags + i + kDoubles);
    } else {  // something is not a number
      one_by_one(i + kSingles);
      continue;
    }
    i += kSingles;
  }
  one_by_one(size);
  return clipped;
}

}  // namespace astroid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astroid {

namespace {
HWY_EXPORT(words_kernel);
HWY_EXPORT(uniforms_kernel);
HWY_EXPORT(normals_kernel);
HWY_EXPORT(add_normals_kernel);
HWY_EXPORT(poisson_kernel);
HWY_EXPORT(digitise_kernel);
}  // namespace

void pixel_words(const RandomStream& stream, const PixelPlaces& pixels, std::span<std::uint32_t> words) {
  check_size(pixels, words.size());
  HWY_DYNAMIC_DISPATCH(words_kernel)(stream, pixels, words.data());
}

void pixel_uniforms(const RandomStream& stream, const PixelPlaces& pixels, std::span<double> uniforms) {
  check_size(pixels, uniforms.size());
  HWY_DYNAMIC_DISPATCH(uniforms_kernel)(stream, pixels, uniforms.data());
}

void pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, std::span<float> normals) {
  check_size(pixels, normals.size());
  HWY_DYNAMIC_DISPATCH(normals_kernel)(stream, pixels, normals.data());
}

void add_pixel_normals(const RandomStream& stream, const PixelPlaces& pixels, double rms, std::span<double> values) {
  check_size(pixels, values.size());
  HWY_DYNAMIC_DISPATCH(add_normals_kernel)(stream, pixels, rms, values.data());
}

void pixel_poisson(const RandomStream& stream, const PixelPlaces& pixels, std::span<const double> mean,
                   std::span<double> counts) {
  check_poisson(pixels, mean, counts);
  HWY_DYNAMIC_DISPATCH(poisson_kernel)(stream, pixels, mean.data(), counts.data());
}

std::size_t digitise_pixels(std::span<const double> counts, double top, std::span<float> digital,
                            std::span<std::uint8_t> flags) {
  ASTROID_CHECK_EQ(counts.size(), digital.size());
  ASTROID_CHECK_EQ(counts.size(), flags.size());
  return HWY_DYNAMIC_DISPATCH(digitise_kernel)(counts.data(), counts.size(), top, digital.data(), flags.data());
}

}  // namespace astroid
#endif
