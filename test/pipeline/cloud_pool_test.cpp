#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"

#include <gtest/gtest.h>
#include <boost/shared_ptr.hpp>
#include <boost/weak_ptr.hpp>

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
using Pool = CloudPool<PanopticCloud>;

/// PCL's pointers are Boost's up to 1.10.
template <typename T>
std::weak_ptr<T> weakPointerTo(const std::shared_ptr<T>& pointer)
{
  return pointer;
}
template <typename T>
boost::weak_ptr<T> weakPointerTo(const boost::shared_ptr<T>& pointer)
{
  return pointer;
}

TEST(CloudPool, aCloudLetGoIsTheNextOne)
{
  Pool pool;
  const PanopticCloud* first = nullptr;
  const PanopticPoint* points = nullptr;
  for (int frame = 0; frame < 5; ++frame)
  {
    const auto cloud = pool.take();
    cloud->points.resize(1000);
    if (frame == 0) first = cloud.get(), points = cloud->points.data();
    EXPECT_EQ(cloud.get(), first);
    EXPECT_EQ(cloud->points.data(), points) << "the same memory, touched before";
  }
  EXPECT_EQ(pool.made(), 1U);
}

TEST(CloudPool, whatAReaderHoldsIsLeftAlone)
{
  Pool pool;
  const auto held = pool.take();
  held->header.seq = 7;
  for (int frame = 0; frame < 5; ++frame)
  {
    const auto cloud = pool.take();
    EXPECT_NE(cloud.get(), held.get());
    cloud->header.seq = 0;
  }
  EXPECT_EQ(held->header.seq, 7U);
  EXPECT_EQ(pool.made(), 2U);
}

TEST(CloudPool, slowReadersGetAsManyAsTheyHoldAndNoMoreAreKeptThanTheBound)
{
  Pool pool(3);
  std::deque<PanopticCloud::Ptr> held;
  std::set<PanopticCloud*> different;
  for (int k = 0; k < 20; ++k) different.insert(held.emplace_back(pool.take()).get());
  EXPECT_EQ(different.size(), 20U);
  held.clear();
  EXPECT_EQ(pool.idle(), 3U);
}

TEST(CloudPool, readersMayOutliveThePool)
{
  PanopticCloud::Ptr held, other;
  {
    Pool pool;
    held = pool.take(), other = pool.take();
    held->points.resize(100);
    held->points[99].instance = 42;
  }
  other.reset();
  EXPECT_EQ(held->points[99].instance, 42U);
  held.reset();  // a leak or a use after free is the sanitizer's to find
}

TEST(CloudPool, aWeakPointerIsNotWokenByTheNextUse)
{
  Pool pool;
  auto cloud = pool.take();
  auto weak = weakPointerTo(cloud);
  cloud.reset();
  EXPECT_TRUE(weak.expired());
  EXPECT_EQ(pool.idle(), 0U) << "its count is still in use";
  const auto next = pool.take();
  EXPECT_TRUE(weak.expired());
  weak.reset();
  EXPECT_EQ(pool.idle(), 1U);
}

/// A writer that stamps each cloud, and readers that let go late, at once, or never before the pool is gone.
TEST(CloudPool, manyReadersInTheirOwnThreads)
{
  constexpr std::uint32_t kFrames = 1000;
  std::mutex mutex;
  std::vector<std::deque<PanopticCloud::ConstPtr>> inbox(4);
  std::atomic<bool> done{false};
  std::atomic<int> torn{0}, read{0};
  auto pool = std::make_unique<Pool>();
  const auto readAll = [&](std::size_t reader)
  {
    std::mt19937 random(static_cast<unsigned>(reader));
    std::deque<PanopticCloud::ConstPtr> held;
    while (true)
    {
      PanopticCloud::ConstPtr cloud;
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!inbox[reader].empty())
        {
          cloud = inbox[reader].front();
          inbox[reader].pop_front();
        }
        else if (done)
          break;
      }
      if (!cloud)
      {
        std::this_thread::yield();
        continue;
      }
      held.push_back(cloud);
      ++read;
      while (held.size() > random() % 6)
      {
        for (const auto& p : held.front()->points) torn += p.instance != held.front()->header.seq ? 1 : 0;
        held.pop_front();
      }
    }
  };
  std::vector<std::thread> readers;
  for (std::size_t reader = 0; reader < inbox.size(); ++reader) readers.emplace_back(readAll, reader);
  for (std::uint32_t frame = 1; frame <= kFrames; ++frame)
  {
    const auto cloud = pool->take();
    cloud->header.seq = frame;
    cloud->points.resize(64);
    for (auto& p : cloud->points) p.instance = frame;
    for (bool is_full = true; is_full; std::this_thread::yield())
    {
      const std::lock_guard<std::mutex> lock(mutex);
      is_full = std::any_of(inbox.begin(), inbox.end(), [](const auto& box) { return box.size() > 8; });
    }
    const std::lock_guard<std::mutex> lock(mutex);
    for (auto& box : inbox) box.push_back(cloud);
  }
  pool.reset();
  done = true;
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(read, static_cast<int>(4 * kFrames));
}
}  // namespace
}  // namespace lidar_panoptic_clustering
