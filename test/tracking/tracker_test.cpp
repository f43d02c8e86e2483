#include "tracker_scene.h"

#include <cstdint>

namespace lidar_panoptic_clustering
{
namespace
{
class TrackerTest : public TrackerScene
{
};

TEST_F(TrackerTest, EveryInstanceHasAnIdInItsFirstScanAndKeepsItWhateverItsNumber)
{
  std::uint32_t parked = 0, moving = 0;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    const std::uint32_t first = k % 2 == 0 ? 1 : 4000000000U;
    car(first, 10.0, 5.0);
    car(77, -20.0 + k, -3.0);
    const auto objects = track(0.1 * k);
    if (k == 0) parked = objects.at(first).track, moving = objects.at(77).track;
    EXPECT_NE(parked, moving);
    EXPECT_GT(parked, 0U);
    ASSERT_EQ(objects.at(first).track, parked) << k;
    ASSERT_EQ(objects.at(77).track, moving) << k;
    EXPECT_EQ(objects.at(77).scans, k + 1U);
    EXPECT_EQ(objects.at(77).first_seen_us, 0);
    if (k < 10) continue;
    EXPECT_NEAR(objects.at(77).velocity.x(), 10.0, 0.3);
    EXPECT_NEAR(objects.at(77).velocity.y(), 0.0, 0.1);
    EXPECT_LT(objects.at(first).velocity.norm(), 0.05);
  }
}

TEST_F(TrackerTest, ASensorThatDrivesAndTurnsSeesAParkedCarAtRest)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 40; ++k)
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << 1e5 + 1.5 * k, 3e5, 1.7;
    pose.linear() = Eigen::AngleAxisd(0.05 * k, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    begin(pose);
    car(1, 1e5 + 30.0, 3e5 + 6.0, 0.4);
    const TrackedObject object = track(0.1 * k).at(1);
    if (k == 0) id = object.track;
    ASSERT_EQ(object.track, id);
    if (k > 5)
    {
      EXPECT_LT(object.velocity.norm(), 0.1);
    }
  }
}

TEST_F(TrackerTest, PathsThatCross)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 60; ++k)
  {
    begin();
    person(1, 10.0 + 0.14 * (k - 30), 0.0);
    person(2, 10.0, 0.14 * (k - 37));
    for (const auto& [instance, object] : track(0.1 * k))
      EXPECT_EQ(ids.emplace(instance, object.track).first->second, object.track) << k;
  }
  EXPECT_NE(ids[1], ids[2]);
}

TEST_F(TrackerTest, Overtaking)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 50; ++k)
  {
    begin();
    car(1, 1.0 * k, 0.0);
    car(2, -15.0 + 1.8 * k, 2.8);
    for (const auto& [instance, object] : track(0.1 * k))
      EXPECT_EQ(ids.emplace(instance, object.track).first->second, object.track) << k;
  }
  EXPECT_NE(ids[1], ids[2]);
}

TEST_F(TrackerTest, HiddenBehindATruckForASecondButNotForTwo)
{
  for (const int hidden : {10, 20})
  {
    std::uint32_t before = 0, after = 0;
    tracker_.reset();
    for (int k = 0; k < 60; ++k)
    {
      begin();
      add(1, "truck", 12.0, 6.0, 12.0, 2.5);
      const bool is_hidden = k >= 20 && k < 20 + hidden;
      if (!is_hidden) car(2, 0.8 * k, 10.0);
      const auto objects = track(0.1 * k);
      if (!is_hidden) (k < 20 ? before : after) = objects.at(2).track;
    }
    EXPECT_EQ(before == after, hidden == 10) << hidden;
  }
}

TEST_F(TrackerTest, OneLeavesAndAnotherEntersAtTheSamePlace)
{
  std::uint32_t first = 0;
  for (int k = 0; k < 20; ++k)
  {
    begin();
    car(1, 10.0 + (k < 10 ? 0.0 : 0.015 * (k - 10) * (k - 10)), 0.0);
    first = track(0.1 * k).at(1).track;
  }
  for (int k = 20; k < 40; ++k)
  {
    begin();
    car(1, 10.0 + 0.015 * (k - 10) * (k - 10), 0.0);
    if (k > 30) car(2, 10.0, 0.0);
    const auto objects = track(0.1 * k);
    EXPECT_EQ(objects.at(1).track, first);
    if (k > 30)
    {
      EXPECT_NE(objects.at(2).track, first);
    }
  }
  // gone for longer than anything is kept: the next one there is new
  begin();
  track(6.0);
  begin();
  car(1, 10.0, 0.0);
  EXPECT_GT(track(6.1).at(1).track, first + 1);
  EXPECT_EQ(tracker_.liveTracks(), 1U);
}

TEST_F(TrackerTest, StopAndTurn)
{
  std::uint32_t id = 0;
  double x = 0.0, y = 0.0, yaw = 0.0, speed = 10.0;
  for (int k = 0; k < 120; ++k)
  {
    begin();
    car(1, x, y, yaw);
    const TrackedObject object = track(0.1 * k).at(1);
    if (k == 0) id = object.track;
    ASSERT_EQ(object.track, id) << k;
    if (k > 65)
    {
      EXPECT_LT(object.velocity.norm(), 0.15) << k;
    }
    x += 0.1 * speed * std::cos(yaw), y += 0.1 * speed * std::sin(yaw);
    if (k >= 10 && k < 30) yaw += 0.1 * speed / 12.0;
    if (k >= 30) speed = std::max(0.0, speed - 0.5);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
