#include "commands/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "astroid/core/worker_pool.hpp"

namespace astroid::commands {

namespace {

using Clock = std::chrono::steady_clock;

/// One line on standard error, redrawn a few times a second by whichever worker comes by.
class Bar {
 public:
  explicit Bar(std::string what) : what_(std::move(what)) {}

  void show(std::int64_t done, std::int64_t all) {
    constexpr auto kRedraw = std::chrono::milliseconds(200);
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() && done < all) return;
    const Clock::time_point now = Clock::now();
    if (done < all && now - last_ < kRedraw) return;
    last_ = now;
    constexpr int kWidth = 30;
    const double share = static_cast<double>(done) / static_cast<double>(std::max<std::int64_t>(1, all));
    const int filled = static_cast<int>(share * kWidth);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double left = done > 0 ? elapsed * (1.0 - share) / share : 0.0;
    fmt::print(stderr, "\r{} [{}{}] {:3.0f} %  {} left   ", what_, std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100.0 * share, duration_text(left));
    if (done == all) fmt::print(stderr, "\r{}\r", std::string(100, ' '));
    std::fflush(stderr);
  }

 private:
  std::string what_;
  std::mutex mutex_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace

Progress progress_bar(const std::string& what) {
  if (isatty(STDERR_FILENO) == 0) return {};
  return [bar = std::make_shared<Bar>(what)](std::int64_t done, std::int64_t all) { bar->show(done, all); };
}

int thread_count(int asked) {
  return asked > 0 ? asked : available_threads();
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kHour = 3600.0;
  if (seconds < kMinute) return fmt::format("{:.1f} s", seconds);
  if (seconds < kHour)
    return fmt::format("{:.0f} min {:.0f} s", std::floor(seconds / kMinute), std::fmod(seconds, kMinute));
  return fmt::format("{:.0f} h {:.0f} min", std::floor(seconds / kHour),
                     std::floor(std::fmod(seconds, kHour) / kMinute));
}

}  // namespace astroid::commands
