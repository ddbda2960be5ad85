#include "astroid/sim/charge_transfer.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "astroid/core/charge_kernels.hpp"
#include "astroid/core/error.hpp"
#include "astroid/core/math.hpp"

namespace astroid {

namespace {

/// Charge further behind a packet is left out when it is less than this share of the packet.
constexpr double kNegligible = 1e-16;

/// The shares of a packet that arrive with it and behind it: C(N+k-1, k) e^k (1-e)^N for k = 0, 1, ...
class Trail {
 public:
  Trail(double loss, int transfers)
      : loss_(loss), transfers_(transfers), log_scale_(transfers * det::log1p(-loss)), scale_(det::exp(log_scale_)) {}

  [[nodiscard]] double share() const { return mantissa_ * scale_; }
  /// Goes on to the next packet. @returns whether anything but a negligible share follows
  bool next() {
    const double n = transfers_;
    const double ratio = (n + k_) / (k_ + 1.0) * loss_;
    mantissa_ *= ratio;
    ++k_;
    // (1-e)^N is too small for a double where a packet is lost many times over; the shares further back are not.
    constexpr double kLarge = 1e200;
    if (mantissa_ > kLarge) {
      mantissa_ /= kLarge;
      log_scale_ += det::log(kLarge);
      scale_ = det::exp(log_scale_);
    }
    // The ratio falls with k towards e: what follows is below a geometric series once it is below 1.
    const double later = (n + k_) / (k_ + 1.0) * loss_;
    return later >= 1.0 || share() > kNegligible * (1.0 - later);
  }

 private:
  double loss_;
  double transfers_;
  double log_scale_;
  double scale_;
  double mantissa_ = 1.0;
  double k_ = 0.0;
};

/// Whether all of a packet arrives, or nothing ever does.
bool is_extreme(double loss) {
  return loss <= 0.0 || loss >= 1.0;
}

double sum(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

constexpr double kBoltzmann = 1.380649e-23;         // J/K, exact (SI 2019)
constexpr double kElectronMass = 9.1093837015e-31;  // kg (CODATA 2018)
constexpr double kEffectiveMass = 0.5;              // of a conduction electron in silicon, in electron masses
constexpr double kPacketDepth = 1e-6;               // m (Short2013: the charge lies in a layer 1 µm deep)
constexpr double kMetresPerMicrometre = 1e-6;

/// What a packet after `transfers` transfers meets of a species.
std::vector<TrapPassage> passages_of_one_transfer(const TrapModel& model) {
  const double beta = model.volume_power;
  const double side = model.pixel_pitch * kMetresPerMicrometre;
  const double volume = 0.5 * side * side * kPacketDepth;
  const double thermal_velocity = det::sqrt(3.0 * kBoltzmann * model.temperature / (kEffectiveMass * kElectronMass));
  const double full_well_power = det::pow(model.full_well.value(), beta);
  const double dwell = model.dwell.value();
  std::vector<TrapPassage> passages;
  for (const TrapSpecies& species : model.species)
    passages.push_back(
        {.volume_power = beta,
         .traps = 2.0 * species.density / (full_well_power * (1.0 + beta)),
         .capture_rate = dwell * species.cross_section * thermal_velocity * full_well_power / (2.0 * volume),
         .released = -det::expm1(-dwell / species.release.value())});
  return passages;
}

}  // namespace

int trail_length(double loss, int transfers) {
  if (is_extreme(loss) || transfers <= 0) return 0;
  Trail trail(loss, transfers);
  int length = 0;
  while (trail.next()) ++length;
  return length;
}

double transfer(const TransferChain& chain, double loss) {
  ASTROID_CHECK_LE(0.0, loss);
  if (loss <= 0.0) return 0.0;
  double lost = 0.0;
  // From the last packet on: those ahead have not been moved yet when they leave their charge behind.
  for (std::size_t i = chain.packets.size(); i-- > 0;) {
    const std::span<double> packet(chain.packets[i], chain.width);
    const int transfers = chain.first_transfers + static_cast<int>(i);
    if (transfers <= 0) continue;
    if (loss >= 1.0) {
      lost += sum(packet);
      std::ranges::fill(packet, 0.0);
      continue;
    }
    Trail trail(loss, transfers);
    const double kept = trail.share();
    double beyond = 0.0;
    for (std::size_t j = i + 1; trail.next(); ++j) {
      if (j < chain.packets.size())
        add_scaled({chain.packets[j], chain.width}, trail.share(), packet);
      else
        beyond += trail.share();
    }
    if (beyond > 0.0) lost += beyond * sum(packet);
    for (double& electrons : packet) electrons *= kept;
  }
  return lost;
}

double transfer_through_traps(const TransferChain& chain, const TrapModel& model) {
  const std::vector<TrapPassage> one = passages_of_one_transfer(model);
  // Columns that stay in the cache together with their traps.
  constexpr std::size_t kAtOnce = 1024;
  std::vector<double> filled;
  double lost = 0.0;
  for (std::size_t begin = 0; begin < chain.width; begin += kAtOnce) {
    const std::size_t width = std::min(kAtOnce, chain.width - begin);
    filled.assign(width * one.size(), 0.0);
    for (std::size_t i = 0; i < chain.packets.size(); ++i) {
      const double transfers = chain.first_transfers + static_cast<int>(i);
      if (transfers <= 0.0) continue;
      const std::span<double> packet(chain.packets[i] + begin, width);
      for (std::size_t k = 0; k < one.size(); ++k) {
        TrapPassage passage = one[k];
        passage.traps *= transfers;
        pass_traps(passage, packet, std::span(filled).subspan(k * width, width));
      }
    }
    lost += sum(filled);
  }
  return lost;
}

}  // namespace astroid
