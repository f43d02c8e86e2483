#include "tracker_scene.h"

#include <limits>
#include <random>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
class TrackerInputTest : public TrackerScene
{
};

TEST_F(TrackerInputTest, ScansThatAreMissingComeTwiceOrOutOfOrder)
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

TEST_F(TrackerInputTest, AJumpInTimeStartsAnewAndUsesNoIdAgain)
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

TEST_F(TrackerInputTest, StampsOfZeroAndInstancesWithoutCoordinates)
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

TEST_F(TrackerInputTest, EqualInputEqualIdsAndBoundedTracks)
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

TEST_F(TrackerInputTest, RefusesParametersOutOfRange)
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
