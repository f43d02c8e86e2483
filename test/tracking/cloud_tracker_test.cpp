#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kCar = 10, kTruck = 18, kRoad = 40;

std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// One row of points.
class Scan
{
public:
  /// The outline of a rectangle of 4 m x 2 m along x, its lower half and its upper half, 0.2 m between points.
  Scan& car(std::uint32_t instance, double x, double y, std::uint32_t label = kCar, double height = 1.5)
  {
    for (int i = 0; i < 60; ++i)
      for (const double z : {0.0, height})
      {
        const double t = 0.2 * i;
        point(instance,
              x + (t < 4.0    ? t - 2.0
                   : t < 6.0  ? 2.0
                   : t < 10.0 ? 8.0 - t
                              : -2.0),
              y + (t < 4.0    ? -1.0
                   : t < 6.0  ? t - 5.0
                   : t < 10.0 ? 1.0
                              : 11.0 - t),
              z, label);
      }
    return *this;
  }
  Scan& point(std::uint32_t instance, double x, double y, double z, std::uint32_t label)
  {
    PanopticPoint p;
    p.x = static_cast<float>(x), p.y = static_cast<float>(y), p.z = static_cast<float>(z);
    p.label = label, p.instance = instance, p.intensity = 0.5F, p.rgb = 7;
    cloud_.points.push_back(p);
    cloud_.width = static_cast<std::uint32_t>(cloud_.points.size());
    cloud_.height = 1;
    return *this;
  }
  const PanopticCloud& cloud() const { return cloud_; }

private:
  PanopticCloud cloud_;
};

class CloudTrackerTest : public testing::Test
{
protected:
  const std::vector<ListedTrack>& follow(double time_s, const PanopticCloud& cloud,
                                         const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
  {
    tracker_.follow(cloud, std::llround(1e6 * time_s), pose);
    tracker_.paint(cloud, out_);
    return tracker_.list(cloud);
  }

  CloudTracker tracker_{kitti()};
  PanopticCloud out_;
};

TEST_F(CloudTrackerTest, PaintsIdsAndLeavesAllElseBitForBit)
{
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Scan scan;
  scan.car(9, 10.0, 3.0).point(0, 1.0, 2.0, 3.0, kRoad).point(4000000000U, kNaN, kNaN, kNaN, kCar).car(2, 20.0, 3.0);
  PanopticCloud cloud = scan.cloud();
  cloud.header.stamp = 77, cloud.header.frame_id = "lidar", cloud.is_dense = false;
  follow(0.0, cloud);
  ASSERT_EQ(out_.size(), cloud.size());
  EXPECT_EQ(out_.width, cloud.width);
  EXPECT_EQ(out_.header.stamp, 77U);
  EXPECT_EQ(out_.header.frame_id, "lidar");
  EXPECT_FALSE(out_.is_dense);
  std::map<std::uint32_t, std::set<std::uint32_t>> tracks;
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    const PanopticPoint &p = cloud.points[i], &q = out_.points[i];
    EXPECT_EQ(std::memcmp(p.data, q.data, sizeof(p.data)), 0);
    EXPECT_EQ(p.intensity, q.intensity);
    EXPECT_EQ(p.label, q.label);
    EXPECT_EQ(p.instance == 0, q.instance == 0);
    if (p.instance == 0)
    {
      EXPECT_EQ(p.rgb, q.rgb);
    }
    tracks[p.instance].insert(q.instance);
  }
  EXPECT_EQ(tracks.size(), 4U);
  for (const auto& [instance, ids] : tracks) EXPECT_EQ(ids.size(), 1U) << instance;
}

TEST_F(CloudTrackerTest, FollowingAndPaintingInOnePassGiveTheSame)
{
  CloudTracker other(kitti());
  PanopticCloud one_pass;
  for (int k = 0; k < 8; ++k)
  {
    Scan scan;
    scan.car(1, 10.0 + k, 3.0, k == 6 ? kTruck : kCar).point(0, 1.0, 2.0, 3.0, kRoad).car(2, 20.0, -3.0);
    for (int i = 0; i < 9000; ++i) scan.point(0, 30.0, 0.001 * i, 0.0, kRoad);  // more than a block
    scan.car(3, 40.0, 3.0);
    PanopticCloud cloud = scan.cloud();
    cloud.header.stamp = 77, cloud.header.frame_id = "lidar", cloud.is_dense = false;
    follow(0.1 * k, cloud);
    other.follow(cloud, std::llround(1e5 * k), Eigen::Isometry3d::Identity(), one_pass);
    ASSERT_EQ(one_pass.size(), out_.size());
    EXPECT_EQ(one_pass.header, out_.header);
    EXPECT_EQ(one_pass.width, out_.width);
    EXPECT_EQ(one_pass.height, out_.height);
    EXPECT_EQ(one_pass.is_dense, out_.is_dense);
    for (std::size_t i = 0; i < out_.size(); ++i)
    {
      const PanopticPoint &p = out_.points[i], &q = one_pass.points[i];
      ASSERT_EQ(std::memcmp(p.data, q.data, sizeof(p.data)), 0) << i;
      ASSERT_EQ(p.intensity, q.intensity);
      ASSERT_EQ(p.label, q.label) << i;
      ASSERT_EQ(p.instance, q.instance) << i;
      ASSERT_EQ(p.rgb, q.rgb) << i;
    }
  }
  PanopticCloud broken;
  broken.width = 3, broken.height = 1;
  EXPECT_THROW(other.follow(broken, 0, Eigen::Isometry3d::Identity(), one_pass), std::invalid_argument);
}

TEST_F(CloudTrackerTest, ListsBoxesAndSpeedsInTheSensorsAxes)
{
  // the sensor looks along the fixed frame's y and drives that way at 2 m/s; the car drives along the fixed x at 6 m/s
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int k = 0; k <= 20; ++k)
  {
    const double t = 0.1 * k;
    pose.translation() = Eigen::Vector3d(100.0, 2.0 * t, 1.7);
    // fixed (100 + 6 t - 6, 20) in the sensor's axes: x ahead is fixed y, y left is fixed -x
    Scan turned;
    const PanopticCloud along = Scan().car(3, 0.0, 0.0).cloud();
    for (const PanopticPoint& p : along.points)
      turned.point(3, 20.0 - 2.0 * t + p.y, -(6.0 * t - 6.0 + p.x), p.z, kCar);
    const auto& list = follow(t, turned.cloud(), pose);
    ASSERT_EQ(list.size(), 1U);
    if (k < 20) continue;
    const ListedTrack& car = list.front();
    EXPECT_EQ(car.object.track, 1U);
    EXPECT_EQ(car.instance, 3U);
    EXPECT_EQ(car.point_count, 120U);
    EXPECT_EQ(car.class_share, 1.0F);
    EXPECT_NEAR(car.velocity.x(), 0.0, 0.05);
    EXPECT_NEAR(car.velocity.y(), -6.0, 0.1);
    EXPECT_NEAR(car.box.x, 16.0, 1e-3);
    EXPECT_NEAR(car.box.y, -6.0, 1e-3);
    EXPECT_NEAR(car.box.length, 4.0, 1e-3);
    EXPECT_NEAR(car.box.yaw, -0.5 * M_PI, 1e-3) << "the way it drives";
    EXPECT_NEAR(car.since_first_seen_s, 2.0, 1e-6);
    EXPECT_GT(car.velocity_covariance(0, 0), 0.0);
    EXPECT_EQ(car.velocity_covariance(2, 2), 0.0);
  }
}

TEST_F(CloudTrackerTest, HiddenObjectsAreListedAfterThreeScansUntilTheyMayBeAnother)
{
  for (int k = 0; k < 10; ++k) follow(0.1 * k, Scan().car(1, 10.0 + 0.5 * k, 3.0).car(2, -20.0, 3.0).cloud());
  const auto& list = follow(1.5, Scan().car(1, -20.0, 3.0).cloud());
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].object.track, 2U);
  EXPECT_EQ(list[1].object.track, 1U);
  EXPECT_EQ(list[1].instance, 0U);
  EXPECT_EQ(list[1].point_count, 0U);
  EXPECT_NEAR(list[1].since_last_seen_s, 0.6, 1e-6);
  EXPECT_NEAR(list[1].box.x, 10.0 + 0.5 * 15, 0.3);
  EXPECT_NEAR(list[1].box.length, 4.0, 1e-3);
  EXPECT_EQ(follow(2.5, Scan().car(1, -20.0, 3.0).cloud()).size(), 1U) << "not seen for 1.6 s";

  CloudTracker young{kitti()};
  for (int k = 0; k < 2; ++k) young.follow(Scan().car(1, 10.0, 3.0).cloud(), 100000 * k, Eigen::Isometry3d::Identity());
  const PanopticCloud none = Scan().point(0, 1.0, 1.0, 1.0, kRoad).cloud();
  young.follow(none, 200000, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(young.list(none).empty());
}

/// Two cars that clustering makes one once they stand close: each point keeps its car's id.
TEST_F(CloudTrackerTest, PartsAnInstanceThatHoldsTwoTracks)
{
  for (int k = 0; k < 10; ++k) follow(0.1 * k, Scan().car(1, 10.0, 3.0).car(2, 10.0, 6.0).cloud());
  const PanopticCloud merged = Scan().car(5, 10.0, 3.0).car(5, 10.0, 6.0).cloud();
  const auto& list = follow(1.0, merged);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].instance, 5U);
  EXPECT_EQ(list[1].instance, 5U);
  for (std::size_t i = 0; i < merged.size(); ++i) EXPECT_EQ(out_.points[i].instance, i < 120 ? 1U : 2U) << i;
}

/// Front and rear of a truck, torn apart by what stands before it: one id, one box.
TEST_F(CloudTrackerTest, PartsOfATornObjectAreOneEntry)
{
  for (int k = 0; k < 10; ++k) follow(0.1 * k, Scan().car(1, 10.0, 3.0).cloud());
  Scan torn;
  const PanopticCloud whole = Scan().car(1, 10.0, 3.0).cloud();
  for (const PanopticPoint& p : whole.points)
    if (p.x < 9.5F || p.x > 10.5F) torn.point(p.x < 9.5F ? 7 : 8, p.x, p.y, p.z, kCar);
  const auto& list = follow(1.0, torn.cloud());
  ASSERT_EQ(list.size(), 1U);
  EXPECT_NEAR(list[0].box.length, 4.0, 1e-3);
  EXPECT_EQ(list[0].point_count, torn.cloud().size());
}

TEST_F(CloudTrackerTest, LabelsFollowTheVoteOverTime)
{
  for (int k = 0; k < 10; ++k) follow(0.1 * k, Scan().car(1, 10.0, 3.0).cloud());
  const PanopticCloud wrong = Scan().car(1, 10.0, 3.0, kTruck).cloud();
  const auto& list = follow(1.0, wrong);
  EXPECT_EQ((*kitti())[list[0].object.class_index].name, "car");
  EXPECT_EQ(list[0].class_share, 0.0F);
  for (const PanopticPoint& point : out_.points) EXPECT_EQ(point.label, kCar);

  CloudTracker without(kitti(), {1.5, false});
  without.follow(Scan().car(1, 10.0, 3.0).cloud(), 0, Eigen::Isometry3d::Identity());
  without.follow(wrong, 100000, Eigen::Isometry3d::Identity());
  without.paint(wrong, out_);
  for (const PanopticPoint& point : out_.points) EXPECT_EQ(point.label, kTruck);
}

TEST_F(CloudTrackerTest, CountsPointsOfUnknownClasses)
{
  follow(0.0, Scan().car(1, 10.0, 3.0).car(2, 20.0, 3.0, 54321).cloud());
  EXPECT_EQ(tracker_.unknownPoints(), 120U);
  EXPECT_EQ(tracker_.instancePoints(), 240U);
}

TEST_F(CloudTrackerTest, RefusesWhatContradictsItself)
{
  PanopticCloud cloud = Scan().car(1, 10.0, 3.0).cloud();
  follow(0.0, cloud);
  const PanopticCloud other = Scan().point(1, 1.0, 1.0, 1.0, kCar).cloud();
  EXPECT_THROW(tracker_.paint(other, out_), std::invalid_argument);
  EXPECT_THROW(tracker_.list(other), std::invalid_argument);
  cloud.width = 3;
  EXPECT_THROW(tracker_.follow(cloud, 0, Eigen::Isometry3d::Identity()), std::invalid_argument);
  EXPECT_THROW(CloudTracker(nullptr), std::invalid_argument);
  EXPECT_THROW(CloudTracker(kitti(), {-1.0, true}), std::invalid_argument);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
