#include "batch_flux.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch_flux.cpp"  // NOLINT(bugprone-macro-parentheses): the name of this file
#include <hwy/foreach_target.h>              // IWYU pragma: keep: compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace astroid::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One vector of frames, or two side by side, so that a pixel's place is looked up once for both.
template <class D>
struct Pair {
  hn::Vec<D> low;
  hn::Vec<D> high;  // of no meaning where there is only one
};

// The sum over terms of weigh(term, counts) for one or two vectors of frames, the first of which begins at `counts`. As
// in EstimatorSet::apply(), four running sums, and the order in which they meet; or all terms in one.
template <std::size_t kStride, bool kTwo, bool kFourSums = true, class D, class Weigh>
HWY_INLINE Pair<D> sum_terms(D d, std::span<const std::uint32_t> pixel, const float* counts, std::size_t last_place,
                             const Weigh& weigh) {
  const hn::Rebind<float, D> narrow;
  const auto zero = hn::Zero(d);
  Pair<D> a{zero, zero};
  Pair<D> b{zero, zero};
  Pair<D> c{zero, zero};
  Pair<D> e{zero, zero};
  const auto add = [&](std::size_t i, Pair<D>& sum) HWY_ATTR {
    const float* place = counts + (pixel[i] & last_place) * kStride;
    sum.low = hn::Add(sum.low, weigh(i, hn::PromoteTo(d, hn::LoadU(narrow, place))));
    if constexpr (kTwo)
      sum.high = hn::Add(sum.high, weigh(i, hn::PromoteTo(d, hn::LoadU(narrow, place + hn::Lanes(d)))));
  };
  std::size_t i = 0;
  if constexpr (!kFourSums) {
    for (; i < pixel.size(); ++i) add(i, a);
    return a;
  }
  for (; i + 4 <= pixel.size(); i += 4) {
    add(i, a);
    add(i + 1, b);
    add(i + 2, c);
    add(i + 3, e);
  }
  if (i < pixel.size()) add(i, a);
  if (i + 1 < pixel.size()) add(i + 1, b);
  if (i + 2 < pixel.size()) add(i + 2, c);
  return {hn::Add(hn::Add(a.low, b.low), hn::Add(c.low, e.low)),
          hn::Add(hn::Add(a.high, b.high), hn::Add(c.high, e.high))};
}

// Writes the fluxes of one or two vectors of frames from frame `first` on; returns whether all are finite.
template <std::size_t kStride, bool kTwo, class D>
HWY_INLINE bool flux_of(D d, const InterleavedFrames& frames, const BatchTerms& terms, std::size_t first,
                        double* flux) {
  const float* counts = frames.counts + first;
  const std::size_t last_place = frames.pixels - 1;
  const auto bias = hn::Set(d, terms.bias);
  Pair<D> level{bias, bias};
  if (!terms.background.empty()) {
    const auto plain = [](std::size_t /*term*/, hn::Vec<D> value) HWY_ATTR { return value; };
    level = sum_terms<kStride, kTwo>(d, terms.background, counts, last_place, plain);
    const auto count = hn::Set(d, static_cast<double>(terms.background.size()));
    level = {hn::Div(level.low, count), hn::Div(level.high, count)};
  }
  const auto weighted = [d, &terms](std::size_t term, hn::Vec<D> value)
                            HWY_ATTR { return hn::Mul(hn::Set(d, static_cast<double>(terms.weight[term])), value); };
  const Pair<D> sum = sum_terms<kStride, kTwo>(d, terms.aperture, counts, last_place, weighted);
  const auto gain = hn::Set(d, terms.gain);
  const auto weight_sum = hn::Set(d, terms.weight_sum);
  const auto offset = hn::Set(d, terms.offset);
  const auto flux_in = [&](hn::Vec<D> s, hn::Vec<D> l)
                           HWY_ATTR { return hn::Sub(hn::Mul(gain, hn::Sub(s, hn::Mul(l, weight_sum))), offset); };
  const auto low = flux_in(sum.low, level.low);
  hn::StoreU(low, d, flux + first);
  bool finite = hn::AllTrue(d, hn::IsFinite(low));
  if constexpr (kTwo) {
    const auto high = flux_in(sum.high, level.high);
    hn::StoreU(high, d, flux + first + hn::Lanes(d));
    finite = hn::AllTrue(d, hn::IsFinite(high)) && finite;
  }
  return finite;
}

template <std::size_t kStride>
HWY_INLINE void sums_of_all(const InterleavedFrames& frames, const BatchTerms& terms,
                            std::span<const std::uint32_t> good, double* aperture, double* background) {
  const hn::CappedTag<double, kStride> d;
  const std::size_t last_place = frames.pixels - 1;
  const auto plain = [](std::size_t /*term*/, hn::Vec<decltype(d)> value) HWY_ATTR { return value; };
  const auto weighted = [d, &terms](std::size_t term, hn::Vec<decltype(d)> value)
                            HWY_ATTR { return hn::Mul(hn::Set(d, static_cast<double>(terms.weight[term])), value); };
  for (std::size_t first = 0; first < kStride; first += hn::Lanes(d)) {
    const float* counts = frames.counts + first;
    hn::StoreU(sum_terms<kStride, false>(d, terms.aperture, counts, last_place, weighted).low, d, aperture + first);
    hn::StoreU(sum_terms<kStride, false, false>(d, good, counts, last_place, plain).low, d, background + first);
  }
}

template <std::size_t kStride>
HWY_INLINE bool flux_of_all(const InterleavedFrames& frames, const BatchTerms& terms, double* flux) {
  const hn::CappedTag<double, kStride> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  constexpr bool kTwo = kStride > kLanes;
  bool finite = true;
  for (std::size_t first = 0; first < kStride; first += kTwo ? 2 * kLanes : kLanes)
    finite = flux_of<kStride, kTwo>(d, frames, terms, first, flux) && finite;
  return finite;
}

bool batch_flux(const InterleavedFrames& frames, const BatchTerms& terms, double* flux) {
  switch (frames.stride) {
    case 4:
      return flux_of_all<4>(frames, terms, flux);
    case 8:
      return flux_of_all<8>(frames, terms, flux);
    default:
      return flux_of_all<16>(frames, terms, flux);
  }
}

void batch_sums(const InterleavedFrames& frames, const BatchTerms& terms, std::span<const std::uint32_t> good,
                double* aperture, double* background) {
  switch (frames.stride) {
    case 4:
      return sums_of_all<4>(frames, terms, good, aperture, background);
    case 8:
      return sums_of_all<8>(frames, terms, good, aperture, background);
    default:
      return sums_of_all<16>(frames, terms, good, aperture, background);
  }
}

void interleave(std::span<const float* const> frames, std::size_t first, std::size_t last,
                const InterleavedFrames& into) {
  constexpr std::size_t kTile = 4;  // pixels and frames that change places among four registers
  // So many pixels of four frames are read whole before the next frames are: sixteen streams would contend for sets.
  constexpr std::size_t kLine = 64;
  const hn::FixedTag<float, kTile> d;
  const std::size_t last_place = into.pixels - 1;
  const auto counts_of = [&](std::size_t frame) { return frames[frame < frames.size() ? frame : 0]; };
  for (std::size_t line = first; line < last; line += kLine) {
    const std::size_t end = std::min(line + kLine, last);
    for (std::size_t frame = 0; frame < into.stride; frame += kTile) {
      std::size_t p = line;
      for (; p + kTile <= end && (p & last_place) + kTile <= into.pixels; p += kTile) {
        const auto a = hn::LoadU(d, counts_of(frame) + p);
        const auto b = hn::LoadU(d, counts_of(frame + 1) + p);
        const auto c = hn::LoadU(d, counts_of(frame + 2) + p);
        const auto e = hn::LoadU(d, counts_of(frame + 3) + p);
        const auto ab_low = hn::InterleaveLower(d, a, b);
        const auto ce_low = hn::InterleaveLower(d, c, e);
        const auto ab_high = hn::InterleaveUpper(d, a, b);
        const auto ce_high = hn::InterleaveUpper(d, c, e);
        float* place = into.counts + (p & last_place) * into.stride + frame;
        hn::Store(hn::ConcatLowerLower(d, ce_low, ab_low), d, place);
        hn::Store(hn::ConcatUpperUpper(d, ce_low, ab_low), d, place + into.stride);
        hn::Store(hn::ConcatLowerLower(d, ce_high, ab_high), d, place + 2 * into.stride);
        hn::Store(hn::ConcatUpperUpper(d, ce_high, ab_high), d, place + 3 * into.stride);
      }
      for (; p < end; ++p)
        for (std::size_t f = frame; f < frame + kTile; ++f)
          into.counts[(p & last_place) * into.stride + f] = counts_of(f)[p];
    }
  }
}

}  // namespace astroid::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astroid::detail {

HWY_EXPORT(batch_flux);
HWY_EXPORT(batch_sums);
HWY_EXPORT(interleave);

bool batch_flux(const InterleavedFrames& frames, const BatchTerms& terms, double* flux) {
  return HWY_DYNAMIC_DISPATCH(batch_flux)(frames, terms, flux);
}

void interleave(std::span<const float* const> frames, std::size_t first, std::size_t last,
                const InterleavedFrames& into) {
  HWY_DYNAMIC_DISPATCH(interleave)(frames, first, last, into);
}

void batch_sums(const InterleavedFrames& frames, const BatchTerms& terms, std::span<const std::uint32_t> good,
                double* aperture, double* background) {
  HWY_DYNAMIC_DISPATCH(batch_sums)(frames, terms, good, aperture, background);
}

std::uint8_t compare_flags(std::span<const std::uint8_t* const> frames, std::span<std::uint8_t> any,
                           std::span<std::uint8_t> varying) {
  constexpr std::size_t kPiece = 4096;  // pixels, so that the results stay in the nearest cache
  std::uint8_t all = 0;
  for (std::size_t first = 0; first < any.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, any.size() - first);
    std::uint8_t* in_any = &any[first];
    std::uint8_t* in_some = &varying[first];
    std::copy_n(frames.front() + first, count, in_any);
    std::fill_n(in_some, count, std::uint8_t{0});
    for (const std::uint8_t* frame : frames.subspan(1)) {
      for (std::size_t p = 0; p < count; ++p) {
        in_some[p] = static_cast<std::uint8_t>(in_some[p] | (in_any[p] ^ frame[first + p]));
        in_any[p] = static_cast<std::uint8_t>(in_any[p] | frame[first + p]);
      }
    }
    for (std::size_t p = 0; p < count; ++p) all = static_cast<std::uint8_t>(all | in_any[p]);
  }
  return all;
}

}  // namespace astroid::detail
#endif  // HWY_ONCE
