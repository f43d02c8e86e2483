#include "graph_fixture.h"
#include "scan_fixture.h"

#include <pcl_conversions/pcl_conversions.h>
#include <pcl_ros/point_cloud.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
class SimulatorGraph : public Graph
{
protected:
  bool start() { return tryLoad(name_, "LidarSimulatorNodelet"); }

  const std::string name_ = newName();
};

TEST_F(SimulatorGraph, PublishesOrganisedScansTruthAndPoseWithOneStamp)
{
  ros::param::set(name_ + "/rate_hz", 2.0);
  ASSERT_TRUE(start());
  Probe<tf2_msgs::TFMessage> tf("/tf");
  Probe<PanopticCloud> ground_truth(name_ + "/ground_truth");
  Probe<LabelledCloud> output(name_ + "/output");
  const auto cloud = output.next();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->height, 64U);
  EXPECT_EQ(cloud->width, 2048U);
  EXPECT_EQ(cloud->points.size(), 64U * 2048U);
  EXPECT_EQ(cloud->header.frame_id, "lidar");

  auto truth = ground_truth.next();
  while (truth && truth->header.stamp < cloud->header.stamp) truth = ground_truth.next();
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->header.stamp, cloud->header.stamp);
  EXPECT_EQ(truth->header.frame_id, "lidar");
  ASSERT_EQ(truth->points.size(), cloud->points.size());
  std::size_t returns = 0, things = 0;
  for (std::size_t i = 0; i < cloud->points.size(); ++i)
  {
    const LabelledPoint& p = cloud->points[i];
    const PanopticPoint& t = truth->points[i];
    EXPECT_EQ(p.label, t.label);
    EXPECT_EQ(std::memcmp(p.data, t.data, 12), 0);
    if (std::isnan(p.x)) continue;
    ++returns;
    const bool thing = (*kittiTable())[kittiTable()->find(p.label)].isThing();
    EXPECT_EQ(t.instance > 0, thing) << "label " << p.label;
    things += thing ? 1 : 0;
  }
  EXPECT_GT(returns, 50000U);
  EXPECT_GT(things, 500U);

  auto transforms = tf.next();
  const auto stamp = pcl_conversions::fromPCL(cloud->header.stamp);
  while (transforms && transforms->transforms.at(0).header.stamp < stamp) transforms = tf.next();
  ASSERT_TRUE(transforms);
  EXPECT_EQ(transforms->transforms[0].header.stamp, stamp);
  EXPECT_EQ(transforms->transforms[0].header.frame_id, "world");
  EXPECT_EQ(transforms->transforms[0].child_frame_id, "lidar");
}

TEST_F(SimulatorGraph, HasTheRingsAndFiringsOfTheSensorAskedFor)
{
  ros::param::set(name_ + "/sensor", "vlp16");
  ASSERT_TRUE(start());
  Probe<LabelledCloud> output(name_ + "/output");
  const auto cloud = output.next();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->height, 16U);
  EXPECT_EQ(cloud->width, 1808U);
}

TEST_F(SimulatorGraph, EndsAfterTheFramesAskedFor)
{
  ros::param::set(name_ + "/frames", 3);
  ros::param::set(name_ + "/rate_hz", 50.0);
  ASSERT_TRUE(start());
  Probe<LabelledCloud> output(name_ + "/output");
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(output.next()) << i;
  ros::WallDuration(0.5).sleep();
  EXPECT_FALSE(output.takeIfThere());
}

TEST_F(SimulatorGraph, UnloadsInTheMiddleOfAScan)
{
  ros::param::set(name_ + "/rate_hz", 100.0);
  Probe<LabelledCloud> output(name_ + "/output");
  for (int i = 0; i < 3; ++i)
  {
    ASSERT_TRUE(start());
    EXPECT_TRUE(output.next());
    EXPECT_TRUE(loader_.unload(name_));
    EXPECT_TRUE(fallsSilent(output));
  }
}

TEST_F(SimulatorGraph, RefusesToLoadWithAParameterItCannotUse)
{
  const auto refusal = [this]
  {
    LogProbe log;
    EXPECT_FALSE(start());
    return log.waitFor("not loaded");
  };
  ros::param::set(name_ + "/traffic_density", 1.5);
  EXPECT_NE(refusal().find("'traffic_density': expected a number from 0 to 1, got 1.5"), std::string::npos);
  ros::param::set(name_ + "/traffic_density", 0.5);
  ros::param::set(name_ + "/seed", "one");
  EXPECT_NE(refusal().find("seed: expected an integer, got a string one"), std::string::npos);
  ros::param::set(name_ + "/seed", 1);
  ros::param::set(name_ + "/frame_id", "/lidar");
  EXPECT_NE(refusal().find("frame_id"), std::string::npos);
  ros::param::set(name_ + "/frame_id", "lidar");
  ros::param::set(name_ + "/sensor", "vlp17");
  EXPECT_NE(refusal().find("sensor 'vlp17': cannot be read; expected a YAML file or one of"), std::string::npos);
  ros::param::set(name_ + "/sensor", "vlp16");
  EXPECT_TRUE(start());
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "simulator_nodelet_test");
}
