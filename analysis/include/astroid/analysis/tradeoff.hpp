// What accuracy costs: settings with their errors and times, and which of them are worth their price.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace astroid {

/// What a setting belongs to.
enum class Sweep {
  kRenderer,    ///< how a star is put on pixels
  kAccuracy,    ///< Simulation/Accuracy, for the whole scene
  kPhotometry,  ///< the method
  kEffect,      ///< one effect left out
  kSeries,      ///< how long a series is
};
std::string to_string(Sweep sweep);

/// One setting, measured. NaN where a number has no meaning.
struct TradeoffRow {
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  Sweep sweep = Sweep::kRenderer;
  std::string setting{};               ///< in words
  std::string parameter{};             ///< to paste after --set; empty: it cannot be chosen
  double value = kNothing;             ///< of what is swept: sub-pixels, nodes, phases, ppm, bins
  double error_rms = kNothing;         ///< ppm of a flux, systematic, against the converged reference
  double error_max = kNothing;         ///< ppm
  double error_drift = kNothing;       ///< ppm rms about the mean of the error of a star that drifts by 1.3 px
  double promised = kNothing;          ///< ppm, where the error is promised to stay below it
  double of_promise = kNothing;        ///< largest error of any star over what it is promised
  double noise_over_bound = kNothing;  ///< measured noise over the Cramér-Rao bound of the flux
  double nsr_error = kNothing;         ///< relative standard error of one star's noise
  double seconds = kNothing;           ///< CPU, of an exposure, per 1000 stars; of kEffect what leaving it out saves
  double seconds_once = kNothing;      ///< CPU, before the first exposure; of kSeries all of it
  double memory = kNothing;            ///< MiB
  double operations = kNothing;        ///< multiplications and additions of an image, as the plan counts them
  bool pareto = false;                 ///< nothing is both faster and more accurate
  bool chosen = false;                 ///< what the plan takes
};

/// Marks what no other row of the same sweep beats in both error and seconds. Times that differ by less than `noise`,
/// relative, count as equal; so do errors below `floor` ppm.
void mark_pareto(std::span<TradeoffRow> rows, double noise = 0.1, double floor = 1e-4);

/// The fastest row of a sweep whose error is below `most` ppm; rows.size() where none is.
std::size_t knee(std::span<const TradeoffRow> rows, Sweep sweep, double most);

}  // namespace astroid
