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
#include <span>

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

HWY_INLINE hn::Vec<Doubles> uniforms(hn::Vec<hn::Half<Unsigned>> word) {
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
    alignas(64) std::array<double, WordBlocks::kBlock + WordBlocks::kSlack> values;
    for (std::size_t k = 0; k < blocks.size(); k += kDoubles)
      hn::StoreU(uniforms(hn::LoadU(du, blocks.words() + k)), d, values.data() + k);
    std::copy_n(values.begin(), blocks.size(), out + blocks.first());
  }
}

// How many vectors are worked on abreast: more chains would not fit into the registers.
constexpr int kNormalsAbreast = 4;
constexpr int kPoissonAbreast = 2;

/// Normals of a block of words, with what poisson_of_large_means() wants to know of them. A pass of its own: the chains
/// of dependent operations are long, and the processor overlaps more of shorter loops.
struct NormalBlock {
  HWY_INLINE NormalBlock(const std::uint32_t* words, std::size_t size) {
    for (std::size_t k = 0; k < size; k += kNormalsAbreast * kSingles) {
      const auto normals = normals_of_words(load_words<kNormalsAbreast>(words + k));
      store(normals.z, z.data() + k);
      store(normals.tail, tail.data() + k);
    }
  }
  template <int N>
  HWY_INLINE Normals<N> at(std::size_t k) const {
    return {load_floats<N>(z.data() + k), load_floats<N>(tail.data() + k)};
  }
  alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kSlack> z;
  alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kSlack> tail;
};

void normals_kernel(const RandomStream& stream, const PixelPlaces& pixels, float* out) {
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    alignas(64) std::array<float, WordBlocks::kBlock + WordBlocks::kSlack> values;
    for (std::size_t k = 0; k < blocks.size(); k += kNormalsAbreast * kSingles)
      store(normals_of_words(load_words<kNormalsAbreast>(blocks.words() + k)).z, values.data() + k);
    std::copy_n(values.begin(), blocks.size(), out + blocks.first());
  }
}

template <int N>
HWY_INLINE void add_normals(const std::uint32_t* words, double rms, double* values) {
  const auto scale = hn::Set(Doubles(), rms);
  const Pairs<N> scaled = each(
      [=](Pair z) {
        return Pair{hn::Mul(scale, z.lower), hn::Mul(scale, z.upper)};
      },
      to_doubles(normals_of_words(load_words<N>(words)).z));
  store(load_doubles<N>(values) + scaled, values);
}

void add_normals_kernel(const RandomStream& stream, const PixelPlaces& pixels, double rms, double* values) {
  WordBlocks blocks(stream, pixels);
  while (blocks.next()) {
    double* const block = values + blocks.first();
    constexpr std::size_t kGroup = kNormalsAbreast * kSingles;
    std::size_t k = 0;
    for (; k + kGroup <= blocks.size(); k += kGroup) add_normals<kNormalsAbreast>(blocks.words() + k, rms, block + k);
    for (; k + kSingles <= blocks.size(); k += kSingles) add_normals<1>(blocks.words() + k, rms, block + k);
    if (k == blocks.size()) continue;
    std::array<double, kSingles> rest{};
    std::copy(block + k, block + blocks.size(), rest.begin());
    add_normals<1>(blocks.words() + k, rms, rest.data());
    std::copy_n(rest.begin(), blocks.size() - k, block + k);
  }
}

/// What poisson() looks at for some vectors of pixels.
template <int N>
struct Means {
  Floats<N> mean;
  Floats<N> fraction;
  Pairs<N> whole;
};

/// Counts of means that may be small: by adding probabilities.
struct SmallMeans {
  const std::uint32_t* words;
  template <int N>
  HWY_INLINE Counts<N> operator()(const Means<N>& means, std::size_t k) const {
    Counts<N> counts =
        poisson_of_small_means(smaller(means.mean, all_of<Floats<N>>(fits::kSmallMean)), load_words<N>(words + k));
    counts.steps = counts.steps - to_singles(means.whole);
    // No mean: the sign is set, or it is not a number.
    const Masks<N> valid = each(
        [](auto mean) {
          const Integers di;
          const auto positive = hn::RebindMask(Singles(), hn::Gt(hn::BitCast(di, mean), hn::Set(di, -1)));
          return hn::And(positive, hn::Eq(mean, mean));
        },
        means.mean);
    counts.decided = counts.decided & valid;
    return counts;
  }
};

/// Counts of means most of which are large: by the continuous quantile.
struct AnyMeans {
  const NormalBlock& normals;
  SmallMeans small;
  template <int N>
  HWY_INLINE Counts<N> operator()(const Means<N>& means, std::size_t k) const {
    Counts<N> counts = poisson_of_large_means(means.mean, means.fraction, normals.at<N>(k));
    const Masks<N> large = means.mean >= fits::kSmallMean;
    if (HWY_LIKELY(everywhere(large))) return counts;
    const Counts<N> of_small = small(means, k);
    counts.steps = choose(large, counts.steps, of_small.steps);
    counts.decided = (large & counts.decided) | ((!large) & of_small.decided);
    return counts;
  }
};

/// Counts of N vectors of pixels, negative where they are undecided. @returns whether all are decided
template <int N, class Method>
HWY_INLINE bool poisson(const Method& method, std::size_t k, const double* mean, double* counts) {
  const Pairs<N> means = load_doubles<N>(mean);
  const Pairs<N> whole = whole_part(means);
  const Counts<N> result =
      method(Means<N>{.mean = to_singles(means), .fraction = to_singles(means - whole), .whole = whole}, k);
  constexpr float kNone = -std::numeric_limits<float>::infinity();
  store(whole + to_doubles(choose(result.decided, result.steps, all_of<Floats<N>>(kNone))), counts);
  return everywhere(result.decided);
}

/// The groups of a block with undecided counts.
struct OpenGroups {
  struct Group {
    std::size_t begin;
    std::size_t size;
  };
  HWY_INLINE void add_unless(bool decided, Group group) {
    groups[count] = group;
    count += decided ? 0U : 1U;
  }
  std::size_t count = 0;
  std::array<Group, WordBlocks::kBlock / kSingles + 1> groups;
};

/// A whole block.
template <class Method>
HWY_INLINE void poisson_block(const Method& method, std::size_t size, const double* mean, double* counts,
                              OpenGroups& open) {
  constexpr std::size_t kGroup = kPoissonAbreast * kSingles;
  std::size_t k = 0;
  for (; k + kGroup <= size; k += kGroup)
    open.add_unless(poisson<kPoissonAbreast>(method, k, mean + k, counts + k), {k, kGroup});
  for (; k + kSingles <= size; k += kSingles)
    open.add_unless(poisson<1>(method, k, mean + k, counts + k), {k, kSingles});
  if (k == size) return;
  std::array<double, kSingles> rest_mean;
  std::array<double, kSingles> rest;
  rest_mean.fill(mean[k]);
  std::copy(mean + k, mean + size, rest_mean.begin());
  open.add_unless(poisson<1>(method, k, rest_mean.data(), rest.data()), {k, size - k});
  std::copy_n(rest.begin(), size - k, counts + k);
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
    OpenGroups open;
    if (any_large) {
      poisson_block(AnyMeans{NormalBlock(blocks.words(), blocks.size()), small}, blocks.size(), block_mean, block,
                    open);
    } else {
      poisson_block(small, blocks.size(), block_mean, block, open);
    }
    for (const OpenGroups::Group& group : std::span(open.groups).first(open.count))
      for (std::size_t i = group.begin; i < group.begin + group.size; ++i)
        if (!(block[i] >= 0.0))
          block[i] = poisson_at_pixel(stream, pixel_at(pixels, blocks.first() + i), block_mean[i], blocks.words()[i]);
  }
}

/// Flags the pixels of a mask. @returns how many they are
HWY_INLINE std::size_t flag_clipped(hn::Mask<Singles> clipped, std::uint8_t* flags) {
  const hn::Rebind<std::uint8_t, Singles> d;
  const Integers di;
  const auto flag = hn::IfThenElseZero(hn::RebindMask(di, clipped), hn::Set(di, pixel_flag::kAdcSaturated));
  hn::StoreU(hn::Or(hn::LoadU(d, flags), hn::DemoteTo(d, flag)), d, flags);
  return hn::CountTrue(Singles(), clipped);
}

std::size_t digitise_kernel(const double* counts, std::size_t size, double top, float* digital, std::uint8_t* flags) {
  const Singles d;
  const auto zero = hn::Zero(d);
  const auto limit = hn::Set(d, static_cast<float>(top));  // exact
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
    // Whole numbers up to the top stay what they are in single precision, and larger ones stay larger.
    const auto rounded = hn::Add(to_singles(nearest(load_doubles<1>(counts + i))).first, zero);
    const auto inside = hn::And(hn::Ge(rounded, zero), hn::Lt(rounded, limit));
    if (HWY_LIKELY(hn::AllTrue(d, inside))) {
      hn::StoreU(rounded, d, digital + i);
    } else if (hn::AllTrue(d, hn::Eq(rounded, rounded))) {
      hn::StoreU(hn::Min(hn::Max(rounded, zero), limit), d, digital + i);
      clipped += flag_clipped(hn::Not(inside), flags + i);
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
