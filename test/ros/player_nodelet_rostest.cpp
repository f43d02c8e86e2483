#include "player_fixture.h"
#include "recorded_data.h"

#include <pcl_conversions/pcl_conversions.h>

namespace lidar_panoptic_clustering
{
namespace
{
TEST_F(Player, PublishesScansGroundTruthAndPosesWithOneStamp)
{
  ASSERT_TRUE(start());
  Listener listener(name_);
  std::uint64_t last_stamp = 0;
  for (int scan = 0; scan < 3; ++scan)
  {
    SCOPED_TRACE(scan);
    const auto cloud = listener.output->next();
    const auto truth = listener.ground_truth.next();
    ASSERT_TRUE(cloud && truth);
    EXPECT_EQ(cloud->height, 4U);
    EXPECT_EQ(cloud->width, 32U);
    EXPECT_EQ(cloud->header.frame_id, "velodyne");
    EXPECT_EQ(returnsIn(*cloud), expectedReturns(scan, kMovingCar));

    EXPECT_EQ(truth->header.frame_id, "velodyne");
    EXPECT_EQ(truth->header.stamp, cloud->header.stamp);
    EXPECT_EQ(returnsIn(*truth), expectedReturns(scan, kMovingCar));
    for (std::size_t i = 0; i < cloud->points.size(); ++i)
    {
      EXPECT_EQ(truth->points[i].label, cloud->points[i].label);
      EXPECT_EQ(truth->points[i].instance, truth->points[i].label == kMovingCar ? 5U : 0U);
    }

    const auto transforms = listener.tf.next();
    ASSERT_TRUE(transforms);
    const auto& transform = transforms->transforms.at(0);
    EXPECT_EQ(transform.header.stamp, pcl_conversions::fromPCL(cloud->header.stamp));
    EXPECT_EQ(transform.header.frame_id, "world");
    EXPECT_EQ(transform.child_frame_id, "velodyne");
    EXPECT_NEAR(transform.transform.translation.x, 2.0 * scan, 1e-9);
    EXPECT_NEAR(transform.transform.translation.y, 0.0, 1e-9);
    EXPECT_NEAR(transform.transform.rotation.w, 1.0, 1e-9);
    EXPECT_GT(cloud->header.stamp, last_stamp);
    last_stamp = cloud->header.stamp;
  }
}

TEST_F(Player, StampsAreTheDataSetsTimesWhereAskedFor)
{
  ros::param::set(name_ + "/stamps", "dataset");
  ASSERT_TRUE(start());
  Probe<LabelledCloud> output(name_ + "/output");
  const auto first = output.next(), second = output.next(), third = output.next();
  ASSERT_TRUE(first && second && third);
  EXPECT_EQ(second->header.stamp - first->header.stamp, 250000U);
  EXPECT_EQ(third->header.stamp - first->header.stamp, 500000U);
}

TEST_F(Player, ClassesCanBeAPredictionWhileGroundTruthStays)
{
  ros::param::set(name_ + "/semantics", root_.string());
  ASSERT_TRUE(start());
  Listener listener(name_);
  const auto cloud = listener.output->next();
  const auto truth = listener.ground_truth.next();
  ASSERT_TRUE(cloud && truth);
  EXPECT_EQ(returnsIn(*cloud), expectedReturns(0, kPerson));
  EXPECT_EQ(returnsIn(*truth), expectedReturns(0, kMovingCar));
}

TEST_F(Player, TheLabelTableSaysWhatPredictedIdsMean)
{
  std::vector<std::uint32_t> training(kScanPoints, 9);
  std::fill(training.begin(), training.begin() + 8, 6);
  for (int scan = 0; scan < 3; ++scan) writeFile(file("predictions", scan, ".label"), training);
  ros::param::set(name_ + "/semantics", root_.string());
  expectRefused("'semantic_kitti_training'");
  ros::param::set(name_ + "/label_table", "semantic_kitti_training");
  Probe<rosgraph_msgs::Log> log("/rosout");
  EXPECT_TRUE(eventually([&log] { return log.subscriber().getNumPublishers() > 0; }));
  ASSERT_TRUE(start());
  Probe<LabelledCloud> output(name_ + "/output");
  const auto cloud = output.next();
  ASSERT_TRUE(cloud);
  EXPECT_EQ(returnsIn(*cloud), expectedReturns(0, kPerson));
  while (const auto message = log.takeIfThere())
    EXPECT_EQ(message->msg.find("unknown parameter"), std::string::npos) << message->msg;
}

TEST_F(Player, LoopsUntilUnloaded)
{
  ros::param::set(name_ + "/loop", true);
  ASSERT_TRUE(start());
  Probe<LabelledCloud> output(name_ + "/output");
  for (int i = 0; i < 8; ++i)
  {
    const auto cloud = output.next();
    ASSERT_TRUE(cloud) << i;
    EXPECT_EQ(returnsIn(*cloud), expectedReturns(i % 3, kMovingCar));
  }
  EXPECT_TRUE(loader_.unload(name_));
  EXPECT_TRUE(fallsSilent(output));
}

TEST_F(Player, RecordedScansArriveWithTheirCars)
{
  REQUIRE_RECORDED_DATA(folder);
  ros::param::set(name_ + "/dataset", fs::absolute(folder).string() + "/semantickitti");
  ros::param::set(name_ + "/sequence", "00");
  ros::param::set(name_ + "/rows", 64);
  ros::param::set(name_ + "/columns", 2048);
  ASSERT_TRUE(start());
  const std::string clusterer = newName();
  ASSERT_TRUE(tryLoad(clusterer, "DepthClusterNodelet", {{clusterer + "/input", name_ + "/output"}}));
  Probe<PanopticCloud> clustered(clusterer + "/output");
  const auto out = clustered.next();
  ASSERT_TRUE(out);
  EXPECT_EQ(out->height, 64U);
  EXPECT_EQ(out->width, 2048U);
  EXPECT_GT(returnsIn(*out).size(), 80000U);
  std::set<std::uint32_t> cars;
  for (const auto& p : out->points)
    if (p.label == kCar) cars.insert(p.instance);
  EXPECT_GT(cars.size(), 5U);
  EXPECT_EQ(cars.count(0), 0U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "player_nodelet_test");
}
