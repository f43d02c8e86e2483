#include "ros/mailbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace lidar_panoptic_clustering
{
namespace
{
TEST(Mailbox, GivesTheNewestItemOnce)
{
  Mailbox<int> mailbox;
  EXPECT_FALSE(mailbox.put(1));
  EXPECT_TRUE(mailbox.put(2));
  EXPECT_TRUE(mailbox.put(3));
  EXPECT_EQ(mailbox.take(), 3);
  EXPECT_FALSE(mailbox.put(4)) << "what was taken is not overwritten";
  EXPECT_EQ(mailbox.take(), 4);
}

TEST(Mailbox, HoldsNothingOfWhatWasTakenOrOverwritten)
{
  Mailbox<std::shared_ptr<int>> mailbox;
  const auto first = std::make_shared<int>(1), second = std::make_shared<int>(2);
  mailbox.put(first);
  mailbox.put(second);
  EXPECT_EQ(first.use_count(), 1);
  EXPECT_EQ(second.use_count(), 2);
  EXPECT_EQ(mailbox.take(), second);
  EXPECT_EQ(second.use_count(), 1);
}

TEST(Mailbox, ClosedOneGivesNothingWhateverItHolds)
{
  Mailbox<int> mailbox;
  mailbox.put(1);
  mailbox.close();
  EXPECT_EQ(mailbox.take(), std::nullopt);
  mailbox.put(2);
  EXPECT_EQ(mailbox.take(), std::nullopt);
}

TEST(Mailbox, ClosingWakesWhoWaits)
{
  Mailbox<int> mailbox;
  std::optional<int> taken = 7;
  std::thread waiting([&] { taken = mailbox.take(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  mailbox.close();
  waiting.join();
  EXPECT_EQ(taken, std::nullopt);
}

/// Every item is either taken or reported as overwritten, and the last one is taken.
TEST(Mailbox, LosesNoItemUnreported)
{
  constexpr int kItems = 100000;
  Mailbox<int> mailbox;
  int taken = 0, last = -1;
  std::thread worker(
      [&]
      {
        while (last != kItems - 1)
        {
          const auto item = mailbox.take();
          EXPECT_GT(*item, last);
          last = *item, ++taken;
        }
      });
  int overwritten = 0;
  for (int i = 0; i < kItems; ++i) overwritten += mailbox.put(i) ? 1 : 0;
  worker.join();
  EXPECT_EQ(taken + overwritten, kItems);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
