// Stars that vary: relative flux against time, averaged over exposures exactly.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace astroid {

/// Times are seconds since the start of the run; amplitudes and depths relative to the catalogued flux.
struct SinusoidalVariation {
  double amplitude, period;
  double phase;  ///< turns at the start of the run: 0 rises through the mean
};

/// Dips of trapezoidal shape, one a period: a transit without limb darkening, or an eclipse. The depth is reached after
/// `ingress` and held until `ingress` before the end.
struct PeriodicDips {
  double depth, duration, ingress, period;
  double epoch;  ///< middle of one of them
};

/// Samples, joined by straight lines.
struct SampledVariation {
  std::string file;
  std::vector<double> time;
  std::vector<double> flux;
  std::vector<double> integral;  ///< of the flux from the first sample to each
};

using VariationComponent = std::variant<SinusoidalVariation, PeriodicDips, std::shared_ptr<const SampledVariation>>;

/// Flux of a star relative to its catalogued one: 1 and the sum of what its components differ from 1 by.
class Variability {
 public:
  void add(VariationComponent component) { components_.push_back(std::move(component)); }

  /// Mean from `begin` to `end`, in closed form.
  /// @accuracy 1e-12 of the amplitude, 1e-9 for dips of a run of years
  [[nodiscard]] double mean(double begin, double end) const;
  /// The most that the flux differs from 1, in either direction.
  [[nodiscard]] double largest_change() const;
  /// The least flux that the components allow together; not below 0 for what read_variables() returns.
  [[nodiscard]] double least() const;
  [[nodiscard]] std::string description() const;

 private:
  std::vector<VariationComponent> components_;
};

struct VariableStar {
  std::string id;
  long line = 0;  ///< of the file
  Variability variability;
};

/// Reads a table of variable stars, a component a row; several rows of one star add up. Columns, of which a row needs
/// those of its kind: id, kind, and
///   sinusoid    amplitude_ppm, period_d, phase_deg (0)
///   transit     depth_ppm, duration_h, ingress_h (0), period_d, epoch_d
///   eclipse     the same, and secondary_ppm (0): the depth half a period later
///   lightcurve  file: columns time_s, flux (relative); relative paths start at the table's folder
/// @param end  s, of the run, which light curves must cover.
/// @throws InputError with every problem; EnvironmentError.
std::vector<VariableStar> read_variables(const std::filesystem::path& path, double end);

}  // namespace astroid
