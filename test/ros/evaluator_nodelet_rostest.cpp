#include "graph_fixture.h"
#include "ros/stamp_matcher.h"
#include "scan_fixture.h"

#include <pcl_ros/point_cloud.h>
#include <std_msgs/Float64.h>
#include <std_srvs/Empty.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
/// 100 pixels in two lines: 60 of a car, 30 of road, 10 without a label.
PanopticCloud::Ptr scene(std::uint64_t stamp, std::uint32_t instance)
{
  const PanopticCloud::Ptr cloud(new PanopticCloud);
  cloud->header.stamp = stamp;
  cloud->width = 50, cloud->height = 2;
  cloud->points.resize(100);
  for (std::size_t i = 0; i < 60; ++i) cloud->points[i].label = kCar, cloud->points[i].instance = instance;
  for (std::size_t i = 60; i < 90; ++i) cloud->points[i].label = kRoad;
  return cloud;
}

/// An evaluator between two publishers of this test.
class EvaluatorGraph : public Graph
{
protected:
  bool start(const nodelet::M_string& remappings = {})
  {
    for (const std::string figure : {"pq", "rq", "sq", "pq_things", "pq_things_present", "lstq", "s_assoc", "s_cls"})
      probes_[figure] = std::make_unique<Probe<std_msgs::Float64>>(name_ + "/" + figure);
    if (!remappings.empty()) return tryLoad(name_, "EvaluatorNodelet", remappings);
    input_ = advertise<PanopticCloud>(name_ + "/input");
    truth_ = advertise<PanopticCloud>(name_ + "/ground_truth");
    if (!tryLoad(name_, "EvaluatorNodelet")) return false;
    waitForSubscriber(input_), waitForSubscriber(truth_);
    return true;
  }

  double next(const std::string& figure)
  {
    const auto message = probes_.at(figure)->next();
    return message ? message->data : -1.0;
  }

  void publish(const ros::Publisher& publisher, const PanopticCloud::Ptr& cloud) const
  {
    publisher.publish(pcl::ros_ptr(cloud));
  }

  const std::string name_ = newName();
  std::map<std::string, std::unique_ptr<Probe<std_msgs::Float64>>> probes_;
  ros::Publisher input_, truth_;
};

TEST_F(EvaluatorGraph, FiguresOfMatchedScans)
{
  ASSERT_TRUE(start());
  DiagnosticsProbe diagnostics(name_);
  const auto predicted = scene(1, 5);
  for (std::size_t i = 0; i < 20; ++i) predicted->points[i].label = kMovingCar;  // one class, one object
  for (std::size_t i = 90; i < 100; ++i)
    predicted->points[i].label = kCar, predicted->points[i].instance = 5;  // ignored
  publish(input_, predicted);
  publish(truth_, scene(1, 9));
  EXPECT_EQ(next("pq_things_present"), 1.0);
  EXPECT_EQ(next("pq_things"), 1.0 / 8.0);
  EXPECT_EQ(next("pq"), 2.0 / 19.0);  // car and road of 19 classes
  EXPECT_EQ(next("rq"), 2.0 / 19.0);
  EXPECT_EQ(next("sq"), 2.0 / 19.0);

  // the truth may come first; a car in two halves is one false negative, and no half has 50 points
  const auto split = scene(2, 5);
  for (std::size_t i = 0; i < 30; ++i) split->points[i].instance = 6;
  publish(truth_, scene(2, 9));
  publish(input_, split);
  EXPECT_DOUBLE_EQ(next("pq_things_present"), 1.0 / 1.5);
  const auto report = diagnostics.waitFor("scans evaluated", "2");
  EXPECT_EQ(report.at("true objects split"), "1");
  EXPECT_EQ(report.at("pq_things_present"), "0.6667");
  EXPECT_EQ(report.at("level"), "0");
}

/// One car of 60 points in three scans: two under one id, the third under another. All classes are right.
TEST_F(EvaluatorGraph, TellsWhetherIdsStay)
{
  ASSERT_TRUE(start());
  DiagnosticsProbe diagnostics(name_);
  for (std::uint64_t stamp = 1; stamp <= 3; ++stamp)
  {
    publish(input_, scene(stamp, stamp < 3 ? 5 : 6));
    publish(truth_, scene(stamp, 9));
  }
  EXPECT_EQ(next("lstq"), 1.0);
  EXPECT_EQ(next("lstq"), 1.0);
  EXPECT_DOUBLE_EQ(next("lstq"), std::sqrt(5.0 / 9.0));
  next("s_assoc"), next("s_assoc");
  EXPECT_DOUBLE_EQ(next("s_assoc"), (120.0 * 120.0 / 180.0 + 60.0 * 60.0 / 180.0) / 180.0);
  EXPECT_EQ(next("s_cls"), 1.0);
  EXPECT_EQ(diagnostics.waitFor("scans evaluated", "3").at("id switches"), "1");
}

TEST_F(EvaluatorGraph, ResetCountsFromZero)
{
  ASSERT_TRUE(start());
  const auto empty = scene(1, 5);
  for (auto& point : empty->points) point.label = kRoad, point.instance = 0;
  publish(input_, empty);
  publish(truth_, scene(1, 9));
  EXPECT_EQ(next("pq_things_present"), 0.0);
  std_srvs::Empty call;
  ASSERT_TRUE(ros::service::call(name_ + "/reset", call));
  publish(input_, scene(2, 5));
  publish(truth_, scene(2, 9));
  EXPECT_EQ(next("pq_things_present"), 1.0);
}

TEST_F(EvaluatorGraph, CloudsWithoutPartnerAreCounted)
{
  ros::param::set(name_ + "/queue_size", 5);
  ASSERT_TRUE(start());
  DiagnosticsProbe diagnostics(name_);
  publish(input_, scene(7, 5));
  publish(truth_, scene(7, 9));
  EXPECT_EQ(next("pq_things_present"), 1.0);
  for (std::uint64_t stamp = 10; stamp < 15; ++stamp) publish(truth_, scene(stamp, 9));
  publish(input_, scene(14, 5));
  EXPECT_EQ(next("pq_things_present"), 1.0);
  const auto report = diagnostics.waitFor("scans evaluated", "2");
  EXPECT_EQ(report.at("ground truths without prediction"), "4");
  EXPECT_EQ(report.at("predictions without ground truth"), "0");
}

TEST_F(EvaluatorGraph, CloudsOfAnotherSizeAreRefusedAndTheNextOneCounts)
{
  ASSERT_TRUE(start());
  DiagnosticsProbe diagnostics(name_);
  const auto small = scene(1, 5);
  small->points.resize(50), small->height = 1;
  publish(input_, small);
  publish(truth_, scene(1, 9));
  const auto report = diagnostics.waitFor("clouds refused", "1");
  EXPECT_NE(report.at("message").find("50 x 2 points, found 50 x 1"), std::string::npos) << report.at("message");
  EXPECT_EQ(report.at("level"), "1");
  publish(input_, scene(2, 5));
  publish(truth_, scene(2, 9));
  EXPECT_EQ(next("pq_things_present"), 1.0);
}

TEST_F(EvaluatorGraph, WrongParametersAreRefused)
{
  ros::param::set(name_ + "/min_points", -1);
  EXPECT_FALSE(start());
}

/// Simulator, cluster nodelet and evaluator as in a vehicle's graph.
TEST_F(EvaluatorGraph, OnTheSimulator)
{
  const std::string simulator = newName(), clusterer = newName();
  ros::param::set(simulator + "/rate_hz", 5.0);
  ASSERT_TRUE(
      start({{name_ + "/input", clusterer + "/output"}, {name_ + "/ground_truth", simulator + "/ground_truth"}}));
  ASSERT_TRUE(tryLoad(clusterer, "ScanLineRunClusterNodelet", {{clusterer + "/input", simulator + "/output"}}));
  ASSERT_TRUE(tryLoad(simulator, "LidarSimulatorNodelet"));
  for (int i = 0; i < 5; ++i)
  {
    const double quality = next("pq_things_present");
    EXPECT_GT(quality, 0.5);
    EXPECT_LE(quality, 1.0);
  }
}

TEST(StampMatcher, EitherSideFirstWithGapsAndJumpsBack)
{
  StampMatcher<int> matcher(3);
  EXPECT_FALSE(matcher.addLeft(1, 10));
  EXPECT_FALSE(matcher.addLeft(2, 20));
  const auto late = matcher.addRight(2, 200);
  ASSERT_TRUE(late);
  EXPECT_EQ(*late, std::make_pair(20, 200));
  EXPECT_EQ(matcher.unmatchedLeft(), 1U);

  EXPECT_FALSE(matcher.addRight(3, 300));
  EXPECT_FALSE(matcher.addRight(1, 100));  // the player begins again
  const auto again = matcher.addLeft(1, 11);
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, std::make_pair(11, 100));
  EXPECT_EQ(matcher.unmatchedRight(), 1U);

  for (std::uint64_t stamp = 5; stamp < 9; ++stamp) EXPECT_FALSE(matcher.addLeft(stamp, 0));
  EXPECT_EQ(matcher.unmatchedLeft(), 2U);
  EXPECT_FALSE(matcher.addRight(5, 0));
  matcher.reset();
  EXPECT_EQ(matcher.unmatchedLeft(), 0U);
  EXPECT_FALSE(matcher.addRight(8, 0));
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "evaluator_nodelet_test");
}
