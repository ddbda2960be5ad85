// CPU time by stage.
#pragma once

#include <ctime>

namespace astroid {

/// CPU seconds that the calling thread has used so far.
inline double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  constexpr double kNanosecond = 1e-9;
  return static_cast<double>(time.tv_sec) + kNanosecond * static_cast<double>(time.tv_nsec);
}

/// Attributes the CPU time of one thread to stages, one after the other.
class StageClock {
 public:
  /// Adds what has passed since the last call, or since the beginning, to a stage.
  void charge(double& stage) {
    const double now = thread_cpu_seconds();
    stage += now - last_;
    last_ = now;
  }

 private:
  double last_ = thread_cpu_seconds();
};

}  // namespace astroid
