#include "astroid/core/worker_pool.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace astroid {

namespace {

// What the workers of one loop share.
class Loop {
 public:
  Loop(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) : count_(count), body_(body) {}

  void work(std::size_t worker) {
    while (!failed_.load(std::memory_order_relaxed)) {
      const std::size_t item = next_.fetch_add(1, std::memory_order_relaxed);
      if (item >= count_) return;
      try {
        body_(worker, item);
      } catch (...) {
        fail(item);
      }
    }
  }

  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  // Every item below one that failed was begun before it, so the lowest failure is always among those that are seen.
  void fail(std::size_t item) {
    const std::lock_guard lock(mutex_);
    if (!exception_ || item < failed_item_) {
      exception_ = std::current_exception();
      failed_item_ = item;
    }
    failed_.store(true, std::memory_order_relaxed);
  }

  std::size_t count_;
  const std::function<void(std::size_t, std::size_t)>& body_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr exception_;
  std::size_t failed_item_ = 0;
};

}  // namespace

int available_threads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
  const auto wanted = static_cast<std::size_t>(threads < 1 ? available_threads() : threads);
  const std::size_t workers = std::min(wanted, count);
  Loop loop(count, body);
  {
    std::vector<std::jthread> others;
    others.reserve(workers);
    try {
      for (std::size_t worker = 1; worker < workers; ++worker)
        others.emplace_back([&loop, worker] { loop.work(worker); });
    } catch (const std::system_error&) {
      // The system grants no more threads; those that run, and this one, do the work.
    }
    loop.work(0);
  }  // joins
  loop.rethrow();
}

}  // namespace astroid
