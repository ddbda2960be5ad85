// How exposures are timed: CPU time of one thread, exposure by exposure, so that other programs on the machine disturb
// little.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <vector>

#include "astroid/sim/simulator.hpp"
#include "bench_scene.hpp"

namespace astroid::bench {

inline constexpr double kMilliseconds = 1e3;  ///< in a second
inline constexpr double kNanoseconds = 1e9;

/// Their lower quartile, 0 of nothing: neighbours on the machine can only add time.
double typical(std::vector<double> times);
/// For differences of times, which neighbours move up and down.
double median(std::vector<double> values);

/// CPU milliseconds of this thread that a call takes.
double cpu_milliseconds(const std::function<void()>& call);

/// Sets the counters "ms" (typical() of the exposures), "ns/pixel", "ns/star" and "exposures/s".
void set_rates(benchmark::State& state, const Scene& scene, const std::vector<double>& milliseconds);

/// Times exposures of a scene, one an iteration, after a first one that fills what is computed once; see set_rates().
/// "predicted ms" is what the plan says, "terms" the number of maps where the noiseless image is a sum of some.
void simulate_exposures(benchmark::State& state, const PlannedScene& planned);

}  // namespace astroid::bench
