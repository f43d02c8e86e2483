// One cloud, latched, as pcl_ros's pcd_to_pointcloud sends it: whoever listens, whenever he comes, gets what comes of
// it.
#include "organizer_fixture.h"

#include <visualization_msgs/MarkerArray.h>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::MarkerArray;

ros::Publisher advertiseLatched(const std::string& topic)
{
  return ros::NodeHandle().advertise<sensor_msgs::PointCloud2>(topic, 1, true);
}

class LatchedInputGraph : public Graph
{
protected:
  void startChain()
  {
    ASSERT_TRUE(tryLoad(organizer_, "OrganizerNodelet",
                        {{organizer_ + "/input", once_},
                         {organizer_ + "/label_input", once_ + "_labels"},
                         {organizer_ + "/panoptic", name_ + "/output"},
                         {organizer_ + "/output_original", name_ + "/output_original"}}));
    ASSERT_TRUE(tryLoad(name_, "BirdsEyeClusterNodelet", {{name_ + "/input", organizer_ + "/output"}}));
  }

  template <class Message>
  void expectNext(Probe<Message>& probe) const
  {
    const auto message = probe.next();
    ASSERT_TRUE(message) << probe.subscriber().getTopic();
  }

  const std::string name_ = newName(), organizer_ = name_ + "_organizer", once_ = name_ + "_once";
};

TEST_F(LatchedInputGraph, ListenersThatWaitForTheNodeletsGetTheResult)
{
  const auto publisher = advertiseLatched(once_);
  publisher.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  Probe<PanopticCloud> output(name_ + "/output");
  Probe<MarkerArray> markers(name_ + "/markers");
  Probe<sensor_msgs::PointCloud2> original(name_ + "/output_original");
  startChain();
  expectNext(output);
  expectNext(markers);
  expectNext(original);
}

TEST_F(LatchedInputGraph, ListenersThatComeLaterGetTheResultToo)
{
  const auto publisher = advertiseLatched(once_);
  publisher.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  startChain();
  Probe<sensor_msgs::PointCloud2> original(name_ + "/output_original");
  expectNext(original);
  Probe<PanopticCloud> output(name_ + "/output");
  const auto cloud = output.next();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(instancesOf(*cloud), instancesOf(runAlgorithm("birds_eye", labelledScene())));
  Probe<MarkerArray> markers(name_ + "/markers");
  expectNext(markers);
  // of the same process and topic: no publisher is told of it
  Probe<PanopticCloud> second(name_ + "/output");
  expectNext(second);
}

TEST_F(LatchedInputGraph, NobodyGetsAnOldResultOnceThePublisherIsGone)
{
  auto publisher = advertiseLatched(once_);
  publisher.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  startChain();
  Probe<PanopticCloud> output(name_ + "/output");
  expectNext(output);
  publisher.shutdown();
  ros::WallDuration(1.5).sleep();
  Probe<MarkerArray> markers(name_ + "/markers");
  output.forget();
  ros::WallDuration(2.5).sleep();
  EXPECT_FALSE(markers.takeIfThere());
  EXPECT_FALSE(output.takeIfThere());
}

TEST_F(LatchedInputGraph, ScanOfAnOrdinaryTopicIsWorkedOnOnce)
{
  const auto publisher = advertise<sensor_msgs::PointCloud2>(once_);
  startChain();
  Probe<PanopticCloud> output(name_ + "/output");
  waitForSubscriber(publisher);
  waitForListener(organizer_ + "/output");
  publisher.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  expectNext(output);
  ros::WallDuration(2.5).sleep();
  EXPECT_FALSE(output.takeIfThere());
}

TEST_F(LatchedInputGraph, LabelsOfALatchedCloudAreKeptWithIt)
{
  ros::param::set(organizer_ + "/labels", "cloud");
  const auto publisher = advertiseLatched(once_), labels = advertiseLatched(once_ + "_labels");
  publisher.publish(toRosMessage(withoutLabels(labelledScene())));
  labels.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  startChain();
  Probe<PanopticCloud> output(name_ + "/output");
  expectNext(output);
  Probe<MarkerArray> markers(name_ + "/markers");
  expectNext(markers);
}

/// A cluster nodelet without an organizer before it.
TEST_F(LatchedInputGraph, ClusterNodeletTakesALatchedCloudItself)
{
  const std::string name = newName();
  const auto publisher = advertiseLatched(name + "/input");
  publisher.publish(toRosMessage(laidOut(labelledScene(), kPlainLayout)));
  ASSERT_TRUE(tryLoad(name, "DepthClusterNodelet"));
  Probe<MarkerArray> markers(name + "/markers");
  expectNext(markers);
  Probe<PanopticCloud> output(name + "/output");
  expectNext(output);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "latched_input_test");
}
