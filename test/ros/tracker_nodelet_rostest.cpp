#include "graph_fixture.h"
#include "tracked_scene.h"

#include <lidar_panoptic_clustering/ObjectArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

class TrackerNodelet : public Graph
{
protected:
  TrackerNodelet() : tf_(advertise<tf2_msgs::TFMessage>("/tf")), name_(newName()) {}

  void start()
  {
    ASSERT_TRUE(tryLoad(name_, "TrackerNodelet"));
    input_ = advertise<PanopticCloud>(name_ + "/input");
    output_ = std::make_unique<Probe<PanopticCloud>>(name_ + "/output");
    objects_ = std::make_unique<Probe<ObjectArray>>(name_ + "/objects");
    waitForSubscriber(input_);
    ASSERT_TRUE(eventually([&] { return objects_->subscriber().getNumPublishers() > 0; }));
    ASSERT_TRUE(eventually([&] { return tf_.getNumSubscribers() > 0; }));
  }

  /// The list of the scan at `seconds`, whose ids swap from scan to scan.
  ObjectArrayConstPtr send(double seconds)
  {
    const bool odd = std::lround(10.0 * seconds) % 2 == 1;
    input_.publish(boost::shared_ptr<const PanopticCloud>(streetScan(seconds, odd ? 1 : 2, odd ? 2 : 1)));
    return objects_->next();
  }

  ros::Publisher tf_, input_;
  std::string name_;
  std::unique_ptr<Probe<PanopticCloud>> output_;
  std::unique_ptr<Probe<ObjectArray>> objects_;
};

/// sensor_origin_ stands in no message: it arrives only where the object itself is handed on.
TEST_F(TrackerNodelet, KeepsIdsAndTellsSpeedsOverGroundByTf)
{
  start();
  for (int i = 0; i <= 15; ++i)
  {
    const double seconds = 0.1 * i;
    tf_.publish(streetTransform(seconds));
    const auto list = send(seconds);
    const auto out = output_->next();
    ASSERT_TRUE(list && out);
    ASSERT_EQ(list->objects.size(), 2U) << seconds;
    EXPECT_EQ(list->header.frame_id, "lidar");
    EXPECT_EQ(list->header.stamp, kStart + ros::Duration(seconds));
    EXPECT_EQ(list->fixed_frame, "odom");
    EXPECT_EQ(list->class_table, "semantic_kitti");
    EXPECT_EQ(list->objects[0].track_id, 1U);
    EXPECT_EQ(list->objects[1].track_id, 2U);
    EXPECT_EQ(list->objects[0].instance_id, i % 2 == 1 ? 1U : 2U);

    EXPECT_EQ(out->sensor_origin_, Eigen::Vector4f(1.0F, 2.0F, 3.0F, 4.0F));
    EXPECT_EQ(out->points.front().instance, 1U);
    EXPECT_EQ(out->points[240].instance, 2U);
    EXPECT_NE(out->points.front().rgb, out->points[240].rgb);
    EXPECT_EQ(out->points.back().instance, 0U);
    EXPECT_EQ(out->points.back().rgb, 0x800080U);
    if (i < 15) continue;
    const Object &standing = list->objects[0], &driving = list->objects[1];
    EXPECT_NEAR(standing.velocity.x, 0.0, 0.05);
    EXPECT_NEAR(driving.velocity.x, kCarMps, 0.1);
    EXPECT_NEAR(driving.velocity.y, 0.0, 0.05);
    EXPECT_GT(driving.velocity_covariance[0], 0.0);
    EXPECT_LT(driving.velocity_covariance[0], 1.0);
    EXPECT_GT(driving.position_covariance[4], 0.0);
    EXPECT_NEAR(standing.pose.position.x, 20.0 - kSensorMps * 1.5, 1e-3);
    EXPECT_NEAR(standing.pose.position.z, -0.75, 1e-3);
    EXPECT_NEAR(driving.size.x, 4.0, 1e-3);
    EXPECT_NEAR(driving.size.y, 2.0, 1e-3);
    EXPECT_NEAR(driving.pose.orientation.w, 1.0, 1e-3) << "its front is where it drives to";
    EXPECT_EQ(driving.class_name, "car");
    EXPECT_EQ(driving.class_id, 10U);
    EXPECT_EQ(driving.class_share, 1.0);
    EXPECT_EQ(driving.points, 240U);
    EXPECT_NEAR(driving.since_first_seen.toSec(), 1.5, 1e-6);
    EXPECT_EQ(driving.since_last_seen, ros::Duration(0.0));
  }
}

TEST_F(TrackerNodelet, WithoutTfFollowsAsSeenFromTheSensorAndSaysSo)
{
  LogProbe log;
  DiagnosticsProbe diagnostics(name_);
  ros::param::set(name_ + "/fixed_frame", "nowhere");
  start();
  ObjectArrayConstPtr list;
  for (int i = 0; i <= 15; ++i)
  {
    list = send(0.1 * i);
    ASSERT_TRUE(list);
    ASSERT_EQ(list->objects.size(), 2U);
    EXPECT_EQ(list->objects[0].track_id, 1U);
  }
  EXPECT_EQ(list->fixed_frame, "");
  EXPECT_NEAR(list->objects[0].velocity.x, -kSensorMps, 0.1) << "relative to the sensor";
  const std::string said = log.waitFor("no tf from nowhere to 'lidar'");
  EXPECT_NE(said.find("ids are lost sooner"), std::string::npos) << said;
  const auto report = diagnostics.waitFor("level", "1");
  EXPECT_NE(report.at("message").find("no tf from nowhere to 'lidar'"), std::string::npos) << report.at("message");
}

TEST_F(TrackerNodelet, WaitsForATransformThatComesLate)
{
  ros::param::set(name_ + "/tf_wait_s", 5.0);
  start();
  tf_.publish(streetTransform(0.0));
  ObjectArrayConstPtr list;
  for (int i = 0; i <= 15; ++i)
  {
    const double seconds = 0.1 * i;
    const auto later = ros::NodeHandle().createWallTimer(
        ros::WallDuration(0.03), [&](const ros::WallTimerEvent&) { tf_.publish(streetTransform(seconds)); }, true);
    list = send(seconds);
    ASSERT_TRUE(list);
    ASSERT_EQ(list->objects.size(), 2U);
    EXPECT_EQ(list->objects[0].track_id, 1U);
    EXPECT_EQ(list->fixed_frame, "odom");
  }
  EXPECT_NEAR(list->objects[0].velocity.x, 0.0, 0.05);
}

TEST_F(TrackerNodelet, GoesByTheLatestTransformAndSaysHowOldItIs)
{
  DiagnosticsProbe diagnostics(name_);
  start();
  tf_.publish(streetTransform(0.0));
  ASSERT_TRUE(send(0.0));
  const auto list = send(0.5);  // within the 30 s of the probe; waits 0.1 s
  ASSERT_TRUE(list);
  EXPECT_EQ(list->fixed_frame, "odom");
  const auto report = diagnostics.waitFor("level", "1");
  EXPECT_NE(report.at("message").find("0.50 s behind the scan"), std::string::npos) << report.at("message");
}

/// A scan whose transform does not come goes on as soon as there is a newer one.
TEST_F(TrackerNodelet, AWaitingScanHoldsUpNoNewerOne)
{
  ros::param::set(name_ + "/tf_wait_s", 10.0);
  start();
  tf_.publish(streetTransform(0.0));
  ASSERT_TRUE(send(0.0));
  const ros::WallTime begin = ros::WallTime::now();
  input_.publish(boost::shared_ptr<const PanopticCloud>(streetScan(0.1, 1, 2)));
  ros::WallDuration(0.2).sleep();
  EXPECT_FALSE(objects_->takeIfThere()) << "it waits";
  input_.publish(boost::shared_ptr<const PanopticCloud>(streetScan(0.2, 1, 2)));
  const auto first = objects_->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->header.stamp, kStart + ros::Duration(0.1)) << "nothing is lost";
  tf_.publish(streetTransform(0.2));
  ASSERT_TRUE(objects_->next());
  EXPECT_LT((ros::WallTime::now() - begin).toSec(), 8.0);
}

TEST_F(TrackerNodelet, ListsHiddenObjectsWhereTheyShouldBe)
{
  start();
  ObjectArrayConstPtr list;
  for (int i = 0; i <= 15; ++i)
  {
    tf_.publish(streetTransform(0.1 * i));
    list = send(0.1 * i);
    ASSERT_TRUE(list);
  }
  const auto without = boost::make_shared<PanopticCloud>(*streetScan(2.0, 1, 2));
  without->points.erase(without->points.begin() + 240, without->points.begin() + 480);
  without->width = static_cast<std::uint32_t>(without->points.size());
  tf_.publish(streetTransform(2.0));
  input_.publish(boost::shared_ptr<const PanopticCloud>(without));
  list = objects_->next();
  ASSERT_TRUE(list);
  ASSERT_EQ(list->objects.size(), 2U);
  const Object& hidden = list->objects[1];
  EXPECT_EQ(hidden.track_id, 2U);
  EXPECT_EQ(hidden.instance_id, 0U);
  EXPECT_EQ(hidden.points, 0U);
  EXPECT_NEAR(hidden.since_last_seen.toSec(), 0.5, 1e-6);
  EXPECT_NEAR(hidden.pose.position.x, 10.0 + 2.0 * (kCarMps - kSensorMps), 0.1);
}

TEST_F(TrackerNodelet, MarkersShowBoxNameSpeedAndWay)
{
  start();
  Probe<visualization_msgs::MarkerArray> markers(name_ + "/markers");
  ASSERT_TRUE(eventually([&] { return markers.subscriber().getNumPublishers() > 0; }));
  visualization_msgs::MarkerArrayConstPtr array;
  for (int i = 0; i <= 15; ++i)
  {
    tf_.publish(streetTransform(0.1 * i));
    ASSERT_TRUE(send(0.1 * i));
    array = markers.next();
    ASSERT_TRUE(array);
  }
  std::map<std::pair<std::string, int>, Marker> shown;
  for (const Marker& marker : array->markers) shown[{marker.ns, marker.id}] = marker;
  EXPECT_EQ(shown.count({"boxes", 1}) + shown.count({"boxes", 2}), 2U);
  EXPECT_EQ((shown[{"texts", 1}].text), "car #1");
  EXPECT_EQ((shown[{"texts", 2}].text), "car #2 8.0 m/s");
  EXPECT_EQ(shown.count({"velocities", 1}), 0U) << "it stands";
  const Marker arrow = shown[{"velocities", 2}];
  ASSERT_EQ(arrow.points.size(), 2U);
  EXPECT_NEAR(arrow.points[1].x - arrow.points[0].x, kCarMps, 0.1);
  const Marker trail = shown[{"trails", 2}];
  ASSERT_GT(trail.points.size(), 10U);
  ASSERT_EQ(trail.points.size(), trail.colors.size());
  EXPECT_LT(trail.colors.front().a, 0.2F) << "it fades";
  EXPECT_EQ(trail.colors.back().a, 1.0F);
  EXPECT_NEAR(trail.points.back().x - trail.points.front().x, 1.5 * kCarMps, 1.0) << "over ground";
  EXPECT_EQ(shown.count({"trails", 1}), 0U);
}

TEST_F(TrackerNodelet, SubscribesOnlyWhileSomeoneListens)
{
  ASSERT_TRUE(tryLoad(name_, "TrackerNodelet"));
  const auto input = advertise<PanopticCloud>(name_ + "/input");
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(input.getNumSubscribers(), 0U);
  const auto follows = [&](auto listener)
  {
    EXPECT_TRUE(eventually([&] { return input.getNumSubscribers() == 1; }));
    listener.reset();
    EXPECT_TRUE(eventually([&] { return input.getNumSubscribers() == 0; }));
  };
  follows(std::make_unique<Probe<ObjectArray>>(name_ + "/objects"));
  follows(std::make_unique<Probe<visualization_msgs::MarkerArray>>(name_ + "/markers"));
  follows(std::make_unique<Probe<PanopticCloud>>(name_ + "/output"));
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "tracker_nodelet_test");
}
