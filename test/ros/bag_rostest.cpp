#include "graph_fixture.h"
#include "labelled_scene.h"

#include <pcl_ros/point_cloud.h>

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
/// Publishes the scene in a layout of its own until ROS ends, for rosbag to record.
int runSender(int argc, char** argv)
{
  ros::init(argc, argv, "sender");
  ros::NodeHandle nh;
  const auto publisher = nh.advertise<sensor_msgs::PointCloud2>("/recorded/scan", 1);
  const auto message = toRosMessage(laidOut(labelledScene(), kOddLayout));
  for (ros::WallRate rate(20.0); ros::ok(); rate.sleep()) publisher.publish(message);
  return 0;
}

class Bag : public Graph
{
};

TEST_F(Bag, GivesTheSameIdsAsTheScanItRecorded)
{
  for (const auto& [algorithm, type] : clusterNodelets())
  {
    SCOPED_TRACE(algorithm);
    const std::string name = newName();
    ASSERT_TRUE(tryLoad(name, type, {{name + "/input", "/played/scan"}}));
    Probe<PanopticCloud> output(name + "/output");
    const auto out = output.next();
    ASSERT_TRUE(out) << "no scan from rosbag";
    EXPECT_EQ(instancesOf(*out), instancesOf(runAlgorithm(algorithm, labelledScene())));
    EXPECT_EQ(out->header.stamp, labelledScene().header.stamp);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  if (argc > 1 && std::strcmp(argv[1], "--sender") == 0) return lidar_panoptic_clustering::runSender(argc, argv);
  const int result = lidar_panoptic_clustering::runGraphTests(argc, argv, "bag_test");
  if (argc > 1) std::filesystem::remove(argv[1]);
  return result;
}
