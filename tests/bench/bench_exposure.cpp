#include "bench_exposure.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace astroid::bench {

namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + place);
  return values[static_cast<std::size_t>(place)];
}

}  // namespace

double typical(std::vector<double> times) {
  return quantile(std::move(times), 0.25);
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

double cpu_milliseconds(const std::function<void()>& call) {
  const double begin = thread_cpu_seconds();
  call();
  return kMilliseconds * (thread_cpu_seconds() - begin);
}

void set_rates(benchmark::State& state, const Scene& scene, const std::vector<double>& milliseconds) {
  const double time = typical(milliseconds);
  const double nanoseconds = kNanoseconds / kMilliseconds * time;
  state.counters["ms"] = time;
  state.counters["exposures/s"] = kMilliseconds / time;
  state.counters["ns/pixel"] = nanoseconds / static_cast<double>(scene.layout()->size());
  state.counters["ns/star"] = nanoseconds / static_cast<double>(scene.stars().size());
}

void simulate_exposures(benchmark::State& state, const PlannedScene& planned) {
  const Simulator simulator(planned.scene, planned.plan, 0);
  ExposureState exposure = simulator.make_state();
  const std::int64_t exposures = planned.scene->mission().simulation.exposures;
  for (std::int64_t k = 0; k < exposures; ++k) simulator.simulate(k, exposure);
  std::vector<double> milliseconds;
  std::int64_t number = 0;
  for (auto _ : state) {
    milliseconds.push_back(cpu_milliseconds([&] { simulator.simulate(number, exposure); }));
    number = (number + 1) % exposures;
  }
  set_rates(state, *planned.scene, milliseconds);
  if (planned.plan->knobs.jitter == JitterTreatment::kPolynomial)
    state.counters["terms"] = static_cast<double>(planned.plan->knobs.polynomial.terms.size());
  state.counters["predicted ms"] = kMilliseconds * planned.plan->seconds_per_exposure;
}

}  // namespace astroid::bench
