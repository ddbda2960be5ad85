#include <algorithm>
#include <vector>

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
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace astroid::tradeoff
