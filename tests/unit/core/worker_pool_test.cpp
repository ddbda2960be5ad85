#include "astroid/core/worker_pool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace astroid {
namespace {

TEST(ParallelFor, DoesEveryItemOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<int> done(1000);  // an int each: written without a lock, by one thread
    parallel_for(threads, done.size(), [&](std::size_t, std::size_t item) { ++done[item]; });
    EXPECT_EQ(done, std::vector<int>(1000, 1));
  }
  parallel_for(4, 0, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, NeverLendsAWorkerTwice) {
  std::vector<std::atomic<int>> busy(4);
  std::atomic<bool> overlap = false;
  parallel_for(4, 200, [&](std::size_t worker, std::size_t) {
    if (busy.at(worker)++ != 0) overlap = true;
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    --busy[worker];
  });
  EXPECT_FALSE(overlap);
}

TEST(ParallelFor, UsesNoMoreWorkersThanItems) {
  std::atomic<std::size_t> largest = 0;
  parallel_for(16, 2, [&](std::size_t worker, std::size_t) {
    if (worker > largest) largest = worker;
  });
  EXPECT_LT(largest, 2U);
}

// Items 5 and up all throw, later ones at once and item 5 late: still it is item 5 that is reported.
TEST(ParallelFor, ThrowsTheFailureOfTheLowestItemForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    try {
      parallel_for(threads, 100, [](std::size_t, std::size_t item) {
        if (item < 5) return;
        if (item == 5) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        throw std::runtime_error(std::to_string(item));
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
  }
}

TEST(ParallelFor, BeginsNothingAfterAFailure) {
  std::atomic<int> begun = 0;
  EXPECT_THROW(parallel_for(2, 1000000,
                            [&](std::size_t, std::size_t item) {
                              ++begun;
                              if (item == 10) throw std::runtime_error("stop");
                            }),
               std::runtime_error);
  EXPECT_LT(begun, 1000000);
}

TEST(ParallelFor, MayBeNested) {
  std::atomic<int> done = 0;
  parallel_for(2, 4, [&](std::size_t, std::size_t) { parallel_for(2, 5, [&](std::size_t, std::size_t) { ++done; }); });
  EXPECT_EQ(done, 20);
}

TEST(AvailableThreads, IsAtLeastOne) {
  EXPECT_GE(available_threads(), 1);
}

}  // namespace
}  // namespace astroid
