#include "tools/support/run_threads.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

TEST(RunThreads, WorksInAsManyAsAreAskedFor)
{
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{7}})
  {
    std::atomic<std::size_t> runs{0};
    runThreads(count, [&] { ++runs; });
    EXPECT_EQ(runs, std::max<std::size_t>(count, 1));
  }
}

TEST(RunThreads, WhatAThreadThrowsIsThrownOnWhenAllHaveEnded)
{
  std::atomic<int> runs{0};
  EXPECT_THROW(runThreads(4,
                          [&]
                          {
                            ++runs;
                            throw std::runtime_error("no memory for buffers");
                          }),
               std::runtime_error);
  EXPECT_EQ(runs, 4);
}

/// Leaves this process room for the stacks of a few threads.
void limitMemory()
{
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  const rlim_t bytes = pages * 4096 + (rlim_t{40} << 20U);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

TEST(RunThreads, FewerThreadsDoTheWorkWhereTheSystemGivesNoMore)
{
  if (kSanitized) GTEST_SKIP() << "a sanitizer's own memory has no limit";
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        limitMemory();
        std::atomic<int> runs{0};
        runThreads(200,
                   [&]
                   {
                     ++runs;
                     std::this_thread::sleep_for(std::chrono::milliseconds(200));
                   });
        std::_Exit(runs > 0 && runs < 200 ? 0 : 1);
      },
      testing::ExitedWithCode(0), "only [0-9]+ of 200 threads");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
