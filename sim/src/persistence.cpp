#include "astroid/sim/persistence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "astroid/core/math.hpp"

namespace astroid {

namespace {

/// One kind of trap: what it takes, and what an exposure and the time to the next one leave in it.
struct Traps {
  double share;
  double after_exposure;
  double after_gap;
  double content = 0.0;
};

/// First exposure of the quarter that one belongs to: it begins at or after the quarter does.
std::int64_t first_of_quarter(std::int64_t exposure, double quarter) {
  if (!(quarter > 0.0)) return 0;
  const double begin = std::ceil(std::floor(static_cast<double>(exposure) / quarter) * quarter);
  return std::min(exposure, static_cast<std::int64_t>(begin));  // whatever rounding does
}

}  // namespace

PersistenceKernel::PersistenceKernel(const PersistenceSettings& settings, Seconds cycle, Seconds exposure,
                                     double left_out) {
  constexpr std::size_t kMostExposures = std::size_t{1} << 20U;
  std::vector<Traps> traps;
  for (std::size_t i = 0; i < settings.fraction.size() && i < settings.time.size(); ++i) {
    if (!(settings.fraction[i] > 0.0)) continue;
    taken_ += settings.fraction[i];
    traps.push_back({.share = settings.fraction[i],
                     .after_exposure = det::exp(-exposure.value() / settings.time[i]),
                     .after_gap = det::exp(-(cycle - exposure).value() / settings.time[i])});
  }
  // The charge of one exposure, 1, and what becomes of it in the following ones.
  for (Traps& kind : traps) kind.content = kind.share;
  released_.push_back(0.0);
  const auto held = [&traps] {
    double sum = 0.0;
    for (const Traps& kind : traps) sum += kind.content;
    return sum;
  };
  while (held() > left_out && released_.size() <= kMostExposures) {
    double charge = 0.0;
    for (Traps& kind : traps) {
      kind.content *= kind.after_gap;
      charge += kind.content * (1.0 - kind.after_exposure);
    }
    for (Traps& kind : traps) kind.content = kind.content * kind.after_exposure + kind.share * charge;
    released_.push_back(released_.back() + charge);
  }
}

double PersistenceKernel::released_within(std::int64_t n) const {
  return released_[static_cast<std::size_t>(std::clamp<std::int64_t>(n, 0, reach()))];
}

std::vector<PastCharge> past_charge(const PersistenceKernel& kernel, std::int64_t exposure, std::int64_t block,
                                    double quarter) {
  std::vector<PastCharge> past;
  const std::int64_t first = std::max<std::int64_t>(0, exposure - kernel.reach());
  for (std::int64_t last = exposure - 1; last >= first;) {
    const std::int64_t stands = block > 0 ? std::max(last / block * block, first_of_quarter(last, quarter)) : 0;
    const double share = kernel.released_within(exposure - stands) - kernel.released_within(exposure - 1 - last);
    past.push_back({.exposure = stands, .share = share});
    last = stands - 1;
  }
  return past;
}

void add_released(std::span<const float> past, double share, std::span<double> electrons) {
  for (std::size_t i = 0; i < electrons.size(); ++i) electrons[i] += share * static_cast<double>(past[i]);
}

void take_trapped(double share, Electrons full_well, std::span<double> electrons) {
  for (double& e : electrons) e -= share * std::min(e, full_well.value());
}

}  // namespace astroid
