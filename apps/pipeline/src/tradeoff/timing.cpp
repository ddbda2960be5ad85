#include <vector>

#include "astroid/core/statistics/quantiles.hpp"
#include "sweeps.hpp"

namespace astroid::tradeoff {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  constexpr double kNano = 1e-9;
  return static_cast<double>(now.tv_sec) + kNano * static_cast<double>(now.tv_nsec);
}

double median_seconds(const std::function<void()>& call, double seconds) {
  constexpr std::size_t kFewest = 5;
  std::vector<double> times;
  double total = 0.0;
  while (times.size() < kFewest || total < seconds) {
    const double begin = cpu_seconds();
    call();
    times.push_back(cpu_seconds() - begin);
    total += times.back();
  }
  return quantile(times, 0.5).value;
}

}  // namespace astroid::tradeoff
