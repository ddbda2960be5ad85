#include "stream_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "astroid/photometry/estimator.hpp"

namespace astroid {
namespace {

constexpr std::size_t kMega = std::size_t{1} << 20;

TEST(StreamSizes, BlocksAreAThousandExposuresWhereMemoryAllows) {
  EXPECT_EQ(block_length(24192, 32240, 1, 1024), 1024);
  EXPECT_EQ(block_length(6, 32240, 1, 1024), 6);
  EXPECT_EQ(block_length(24192, 100, 24, 1024), 1024);
  EXPECT_EQ(block_length(0, 100, 1, 1024), 1) << "a run without exposures has no blocks, but their length is not 0";
}

TEST(StreamSizes, BlocksOfManyTargetsStayBelowThreeHundredMegabytesOrAtSixteenExposures) {
  for (const std::size_t targets : {32240U, 300000U, 1000000U})
    for (const int cameras : {1, 24}) {
      const auto length = static_cast<std::size_t>(block_length(1000000, targets, cameras, 1024));
      EXPECT_GE(length, 16U);
      const std::size_t bytes_of_an_exposure = targets * (cameras > 1 ? 21 : 8);
      EXPECT_LE(length * bytes_of_an_exposure, std::max(288 * kMega, 16 * bytes_of_an_exposure)) << targets;
    }
}

TEST(StreamSizes, BatchesOfLargeFramesAreShort) {
  EXPECT_EQ(batch_length(480 * 480), EstimatorSet::kMaxBatch);
  EXPECT_EQ(batch_length(1024 * 1024), 8U);
  EXPECT_EQ(batch_length(2048 * 2048), 2U);
  EXPECT_EQ(batch_length(4510 * 4510), 1U);
  EXPECT_EQ(batch_length(1), EstimatorSet::kMaxBatch);
}

TEST(StreamSizes, BatchesCoverABlockOnceAndCrossNoBoundary) {
  for (const std::size_t longest : {1U, 2U, 8U, 16U})
    for (const int threads : {1, 2, 3, 64})
      for (std::size_t count = 0; count < 200; ++count) {
        std::size_t next = 0;
        for (const Batch& batch : divide_into_batches(count, longest, threads)) {
          ASSERT_EQ(batch.begin, next);
          ASSERT_GE(batch.count, 1U);
          ASSERT_LE(batch.begin % longest + batch.count, longest) << count << " exposures, " << threads << " threads";
          next += batch.count;
        }
        ASSERT_EQ(next, count);
      }
}

TEST(StreamSizes, EveryWorkerGetsItsShareOfAShortRun) {
  EXPECT_EQ(divide_into_batches(6, 16, 2).size(), 6U);
  EXPECT_GE(divide_into_batches(64, 16, 8).size(), 16U);
  // A long run is mostly whole batches, with shorter ones at its end.
  const std::vector<Batch> batches = divide_into_batches(1024, 16, 2);
  EXPECT_LE(batches.size(), 1024U / 16U + 8U);
  EXPECT_EQ(batches.front().count, 16U);
  EXPECT_EQ(batches.back().count, 4U);
}

}  // namespace
}  // namespace astroid
