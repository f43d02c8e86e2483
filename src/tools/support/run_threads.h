#pragma once

#include <cstddef>
#include <exception>
#include <iostream>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Runs `work()` in up to `count` threads, this one among them, and waits for all. Where the system gives fewer
/// threads, the work is done by those, which is said on stderr once; what a thread throws is thrown on here when all
/// have ended.
template <class Work>
void runThreads(std::size_t count, const Work& work)
{
  std::mutex mutex;
  std::exception_ptr failure;
  const auto guarded = [&]
  {
    try
    {
      work();
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(count);
  try
  {
    while (threads.size() + 1 < count) threads.emplace_back(guarded);
  }
  catch (const std::system_error& error)
  {
    std::cerr << "only " << threads.size() + 1 << " of " << count << " threads: " << error.what() << "\n";
  }
  guarded();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}
}  // namespace lidar_panoptic_clustering
