#include "damaged_cloud.h"
#include "graph_fixture.h"
#include "labelled_scene.h"

#include <pcl_ros/point_cloud.h>

namespace lidar_panoptic_clustering
{
namespace
{
class OrganizerGraph : public Graph
{
protected:
  bool start() { return tryLoad(name_, "OrganizerNodelet"); }

  const std::string name_ = newName();
};

/// The scene's pixels in the cloud: same label, same coordinates, NaN for what is no return.
void expectScene(const LabelledCloud& cloud)
{
  const LabelledCloud scene = labelledScene();
  ASSERT_EQ(cloud.width, scene.width);
  ASSERT_EQ(cloud.height, scene.height);
  EXPECT_EQ(cloud.header.frame_id, scene.header.frame_id);
  EXPECT_EQ(cloud.header.stamp, scene.header.stamp);
  for (std::size_t i = 0; i < scene.points.size(); ++i)
  {
    const auto &found = cloud.points[i], &sent = scene.points[i];
    EXPECT_EQ(found.label, sent.label);
    const bool is_return = !std::isnan(sent.x) && (sent.x != 0.0F || sent.y != 0.0F || sent.z != 0.0F);
    EXPECT_EQ(std::isnan(found.x), !is_return) << i;
    if (!is_return) continue;
    EXPECT_EQ(found.x, sent.x);
    EXPECT_EQ(found.y, sent.y);
    EXPECT_EQ(found.z, sent.z);
  }
}

TEST_F(OrganizerGraph, TakesEitherOrientationAndAnyLayout)
{
  ros::param::set(name_ + "/orientation", "rows_are_firings");
  ASSERT_TRUE(start());
  const auto input = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  Probe<LabelledCloud> output(name_ + "/output");
  waitForSubscriber(input);
  for (const auto& layout : {kPlainLayout, kOddLayout})
  {
    input.publish(toRosMessage(transposed(laidOut(labelledScene(), layout))));
    const auto cloud = output.next();
    ASSERT_TRUE(cloud);
    expectScene(*cloud);
  }
}

TEST_F(OrganizerGraph, FeedsAClusterNodeletOfItsManager)
{
  ros::param::set(name_ + "/orientation", "rows_are_rings");
  ros::param::set(name_ + "/label_field", "class_id");
  ASSERT_TRUE(start());
  const std::string clusterer = newName();
  ASSERT_TRUE(tryLoad(clusterer, "ScanLineRunClusterNodelet", {{clusterer + "/input", name_ + "/output"}}));
  const auto input = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  ros::WallDuration(0.2).sleep();
  EXPECT_EQ(input.getNumSubscribers(), 0U) << "nobody listens at the end of the chain";

  Probe<PanopticCloud> output(clusterer + "/output");
  ASSERT_TRUE(eventually([&] { return input.getNumSubscribers() == 1; }));
  RawMessage raw = laidOut(labelledScene(), kPlainLayout);
  for (auto& field : raw.header.fields)
    if (field.name == "label") field.name = "class_id";
  input.publish(toRosMessage(raw));
  const auto out = output.next();
  ASSERT_TRUE(out);
  EXPECT_EQ(instancesOf(*out), instancesOf(runAlgorithm("scan_line_run", labelledScene())));
}

TEST_F(OrganizerGraph, BadCloudsAreDroppedWithTheirReasonAndTheNextOneIsTaken)
{
  ros::param::set(name_ + "/orientation", "rows_are_rings");
  LogProbe log;
  ASSERT_TRUE(start());
  DiagnosticsProbe diagnostics(name_);
  const auto input = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  Probe<LabelledCloud> output(name_ + "/output");
  waitForSubscriber(input);
  const auto good = toRosMessage(laidOut(labelledScene(), kPlainLayout));
  const auto short_of_data = boost::make_shared<sensor_msgs::PointCloud2>(*good);
  short_of_data->data.resize(77);
  const auto big_endian = boost::make_shared<sensor_msgs::PointCloud2>(*good);
  big_endian->is_bigendian = 1;

  input.publish(short_of_data);
  const std::string message = log.waitFor("dropped");
  EXPECT_NE(message.find(name_ + "/input"), std::string::npos) << message;
  EXPECT_NE(message.find("found 77"), std::string::npos) << message;
  EXPECT_EQ(diagnostics.waitFor("scans refused", "1")["last error"], message);
  input.publish(big_endian);
  EXPECT_NE(diagnostics.waitFor("scans refused", "2")["last error"].find("is_bigendian"), std::string::npos);
  input.publish(good);
  const auto cloud = output.next();
  ASSERT_TRUE(cloud);
  expectScene(*cloud);
  EXPECT_EQ(diagnostics.waitFor("scans processed", "1")["scans refused"], "2");
}

/// roscpp reads a message once for both.
TEST_F(OrganizerGraph, DamagedCloudIsRefusedByEachOfTwoOrganizersOfOneTopic)
{
  const std::string second = newName();
  ASSERT_TRUE(start());
  ASSERT_TRUE(tryLoad(second, "OrganizerNodelet", {{second + "/input", name_ + "/input"}}));
  DiagnosticsProbe of_first(name_), of_second(second);
  const auto damaged = advertise<DamagedCloud>(name_ + "/input");
  const auto whole = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  Probe<LabelledCloud> output(name_ + "/output"), second_output(second + "/output");
  waitForSubscriber(damaged);
  waitForSubscriber(whole);
  const auto good = toRosMessage(laidOut(labelledScene(), kPlainLayout));
  // to the publishers the two are one subscriber: that each has subscribed shows when clouds come through
  for (auto* probe : {&output, &second_output})
    ASSERT_TRUE(eventually(
        [&]
        {
          whole.publish(good);
          return probe->takeIfThere() != nullptr;
        }));
  for (const std::string refused : {"1", "2", "3"})  // one by one: of a burst the queue may drop some
  {
    damaged.publish(boost::make_shared<DamagedCloud>(DamagedCloud{*good}));
    for (auto* diagnostics : {&of_first, &of_second})
      EXPECT_NE(
          diagnostics->waitFor("scans refused", refused)["last error"].find("expected a whole sensor_msgs/PointCloud2"),
          std::string::npos);
  }
  for (auto* probe : {&output, &second_output}) probe->forget();
  whole.publish(good);
  for (auto* probe : {&output, &second_output})
  {
    const auto cloud = probe->next();
    ASSERT_TRUE(cloud);
    expectScene(*cloud);
  }
  for (auto* diagnostics : {&of_first, &of_second})
    EXPECT_EQ(diagnostics->waitFor("scans refused", "3")["input"], "by pointer from " + ros::this_node::getName());
}

TEST_F(OrganizerGraph, RefusesToLoadWithAnOrientationThatDoesNotExist)
{
  LogProbe log;
  ros::param::set(name_ + "/orientation", "sideways");
  EXPECT_FALSE(start());
  const std::string message = log.waitFor("not loaded");
  EXPECT_NE(message.find("orientation"), std::string::npos) << message;
  EXPECT_NE(message.find("'sideways'"), std::string::npos) << message;
  ros::param::set(name_ + "/orientation", "auto");
  EXPECT_TRUE(start());
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_nodelet_test");
}
