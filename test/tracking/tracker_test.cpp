#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// A sequence of scans of rectangles, 10 a second.
class TrackerTest : public testing::Test
{
protected:
  void begin(const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
  {
    pose_ = pose;
    builder_.begin(pose);
  }

  /// The points of a rectangle's sides, 5 cm apart, in the fixed frame [m].
  void add(std::uint32_t instance, const std::string& name, double x, double y, double length, double width,
           double yaw = 0.0)
  {
    for (double along = -0.5; along <= 0.5; along += 0.05 / length)
      for (double side : {-0.5, 0.5}) addPoint(instance, name, x, y, along * length, side * width, yaw);
    for (double along = -0.5; along <= 0.5; along += 0.05 / width)
      for (double side : {-0.5, 0.5}) addPoint(instance, name, x, y, side * length, along * width, yaw);
  }
  void car(std::uint32_t instance, double x, double y, double yaw = 0.0) { add(instance, "car", x, y, 4.5, 1.8, yaw); }
  void person(std::uint32_t instance, double x, double y) { add(instance, "person", x, y, 0.5, 0.5); }

  /// Follows what was added; the objects by the instance's number.
  std::map<std::uint32_t, TrackedObject> track(double time_s)
  {
    const Observations& observations = builder_.finish();
    const auto& objects = tracker_.update(std::llround(1e6 * time_s), observations);
    std::map<std::uint32_t, TrackedObject> by_instance;
    for (std::size_t i = 0; i < objects.size(); ++i) by_instance[observations.list[i].instance] = objects[i];
    EXPECT_EQ(by_instance.size(), objects.size());
    return by_instance;
  }

  Tracker tracker_{kitti()};

private:
  void addPoint(std::uint32_t instance, const std::string& name, double x, double y, double along, double across,
                double yaw)
  {
    const Eigen::Vector3d fixed(x + std::cos(yaw) * along - std::sin(yaw) * across,
                                y + std::sin(yaw) * along + std::cos(yaw) * across, 0.5);
    const Eigen::Vector3f p = (pose_.inverse() * fixed).cast<float>();
    builder_.add(instance, kitti()->findByName(name), p.x(), p.y(), p.z());
  }

  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  ObservationBuilder builder_{kitti()};
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

TEST_F(TrackerTest, PartsOfATornObjectHaveItsId)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    const double x = 10.0 + 0.5 * k;
    const bool is_torn = k >= 10 && k % 2 == 0;
    if (is_torn)
    {
      add(1, "car", x - 1.2, 3.0, 2.1, 1.8);
      add(2, "car", x + 1.5, 3.0, 1.5, 1.8);
    }
    else
      car(1, x, 3.0);
    car(3, x, 9.0);
    const auto objects = track(0.1 * k);
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
    if (is_torn)
    {
      EXPECT_EQ(objects.at(2).track, id) << k;
    }
    EXPECT_NE(objects.at(3).track, id);
  }
}

TEST_F(TrackerTest, TwoThatAScanMergesAreToldApartAgain)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 40; ++k)
  {
    begin();
    const bool is_merged = k >= 15 && k < 22;
    person(1, 10.0 + 0.1 * k, 0.0);
    person(is_merged ? 1 : 2, 10.0 + 0.1 * k, 0.9);
    const auto objects = track(0.1 * k);
    if (k == 0) ids = {{1, objects.at(1).track}, {2, objects.at(2).track}};
    if (is_merged) continue;
    EXPECT_EQ(objects.at(1).track, ids[1]) << k;
    EXPECT_EQ(objects.at(2).track, ids[2]) << k;
  }
}

TEST_F(TrackerTest, ACarCalledTruckForThreeScansStaysACar)
{
  const ClassIndex is_car = kitti()->findByName("car"), is_truck = kitti()->findByName("truck");
  for (const bool vote : {true, false})
  {
    TrackerConfig config;
    config.vote_over_time = vote;
    tracker_.configure(config);
    std::set<std::uint32_t> ids;
    for (int k = 0; k < 20; ++k)
    {
      begin();
      const bool is_wrong = k >= 8 && k < 11;
      add(1, is_wrong ? "truck" : "car", 10.0, 0.0, 4.5, 1.8);
      const TrackedObject object = track(0.1 * k).at(1);
      ids.insert(object.track);
      EXPECT_EQ(object.class_index, is_wrong && !vote ? is_truck : is_car) << k;
    }
    EXPECT_EQ(ids.size(), 1U);
    tracker_.reset();
  }
}

TEST_F(TrackerTest, ScansThatAreMissingComeTwiceOrOutOfOrder)
{
  const int order[] = {0, 1, 2, 2, 3, 4, 3, 5, 9, 10, 10, 8, 11, 12, 13};
  std::map<std::uint32_t, std::uint32_t> ids;
  for (const int k : order)
  {
    begin();
    car(1, 1.0 * k, 0.0);
    person(2, 10.0, 5.0 + 0.1 * k);
    for (const auto& [instance, object] : track(0.1 * k))
      EXPECT_EQ(ids.emplace(instance, object.track).first->second, object.track) << k;
  }
  EXPECT_EQ(tracker_.liveTracks(), 2U);
}

TEST_F(TrackerTest, AJumpInTimeStartsAnewAndUsesNoIdAgain)
{
  std::set<std::uint32_t> seen;
  for (int round = 0; round < 3; ++round)
  {
    std::set<std::uint32_t> ids;
    for (int k = 0; k < 30; ++k)
    {
      begin();
      car(1, 10.0, 0.0);
      ids.insert(track(0.1 * k).at(1).track);
    }
    EXPECT_EQ(ids.size(), 1U);
    EXPECT_TRUE(seen.insert(*ids.begin()).second);
  }
}

TEST_F(TrackerTest, StampsOfZeroAndInstancesWithoutCoordinates)
{
  ObservationBuilder builder(kitti());
  std::set<std::uint32_t> ids;
  for (int k = 0; k < 5; ++k)
  {
    builder.begin(Eigen::Isometry3d::Identity());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    builder.add(9, kitti()->findByName("car"), nan, nan, nan);
    builder.add(3, kitti()->findByName("car"), 5.0F, 1.0F, 0.0F);
    builder.add(4, kitti()->findByName("car"), 3e38F, -3e38F, 0.0F);
    const auto& objects = tracker_.update(0, builder.finish());
    ASSERT_EQ(objects.size(), 3U);
    for (const TrackedObject& object : objects) EXPECT_GT(object.track, 0U);
    ids.insert(objects[1].track);
  }
  EXPECT_EQ(ids.size(), 1U);
}

TEST_F(TrackerTest, EqualInputEqualIdsAndBoundedTracks)
{
  Tracker other(kitti());
  ObservationBuilder builder(kitti());
  std::mt19937 random(3);
  const auto coordinate = [&] { return 0.01F * static_cast<float>(random() % 10000) - 50.0F; };
  for (int k = 0; k < 10000; ++k)
  {
    builder.begin(Eigen::Isometry3d::Identity());
    const std::size_t count = random() % 20;
    for (std::uint32_t i = 1; i <= count; ++i)
      builder.add(i, kitti()->findByName(random() % 2 == 0 ? "car" : "person"), coordinate(), coordinate(), 0.0F);
    const Observations& observations = builder.finish();
    const auto& ours = tracker_.update(100000 * k, observations);
    const auto& theirs = other.update(100000 * k, observations);
    for (std::size_t i = 0; i < ours.size(); ++i) ASSERT_EQ(ours[i].track, theirs[i].track);
    ASSERT_LE(tracker_.liveTracks(), 20U * 17U);
  }
}

TEST_F(TrackerTest, RefusesParametersOutOfRange)
{
  EXPECT_THROW(Tracker(nullptr), std::invalid_argument);
  TrackerConfig config;
  config.max_missed_s = -0.1;
  EXPECT_THROW(Tracker(kitti(), config), std::invalid_argument);
  config.max_missed_s = 60.1;
  EXPECT_THROW(tracker_.configure(config), std::invalid_argument);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
