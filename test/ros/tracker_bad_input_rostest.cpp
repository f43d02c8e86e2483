#include "graph_fixture.h"
#include "tracked_scene.h"

#include <lidar_panoptic_clustering/ObjectArray.h>

#include <functional>
#include <limits>
#include <memory>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
struct BadScan
{
  const char* name;
  std::function<void(PanopticCloud&)> spoil;
  const char* word;     ///< part of what the diagnostics say; "": it is nothing to warn of
  std::size_t objects;  ///< of its list
};

void dropInstances(PanopticCloud& cloud)
{
  for (auto& point : cloud.points) point.instance = 0;
}

const std::vector<BadScan>& badScans()
{
  static const std::vector<BadScan> list = {
      {"OnlyIdZero", dropInstances, "", 0},
      {"IdsFarApart",
       [](PanopticCloud& cloud)
       {
         for (auto& point : cloud.points)
           if (point.instance != 0) point.instance = point.instance == 1 ? 0xFFFFFFFF : 0x10000;
       },
       "", 2},
      {"AnotherSize",
       [](PanopticCloud& cloud)
       {
         cloud.points.resize(cloud.points.size() + 777);
         cloud.width = static_cast<std::uint32_t>(cloud.points.size());
       },
       "", 2},
      {"StampOfZero", [](PanopticCloud& cloud) { cloud.header.stamp = 0; }, "a stamp of 0", 2},
      {"StampGoesBackALittle", [](PanopticCloud& cloud) { cloud.header.stamp -= 500000; }, "teaches nothing", 2},
      {"StampGoesBackFar", [](PanopticCloud& cloud) { cloud.header.stamp -= 100000000; }, "", 2},
      {"StampFarAhead", [](PanopticCloud& cloud) { cloud.header.stamp += 10000000000; }, "", 2},
      {"UnknownFrame", [](PanopticCloud& cloud) { cloud.header.frame_id = "moon"; }, "no tf from odom to 'moon'", 2},
      {"NoFrame", [](PanopticCloud& cloud) { cloud.header.frame_id.clear(); }, "has no frame_id", 2},
      {"UnknownClasses",
       [](PanopticCloud& cloud)
       {
         for (auto& point : cloud.points) point.label = 54321;
       },
       "does not know the classes", 2},
      {"NoCoordinates",
       [](PanopticCloud& cloud)
       {
         for (auto& point : cloud.points) point.x = std::numeric_limits<float>::quiet_NaN();
       },
       "", 0},
      {"NoPoints", [](PanopticCloud& cloud) { cloud.points.clear(), cloud.width = cloud.height = 0; }, "", 0},
  };
  return list;
}

class BadInput : public Graph, public testing::WithParamInterface<BadScan>
{
};
INSTANTIATE_TEST_SUITE_P(Scans, BadInput, testing::ValuesIn(badScans()),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// Nothing is lost: the bad scan comes out, and the one after it is as good as ever.
TEST_P(BadInput, IsSaidAndTheNodeLivesOn)
{
  const auto tf = advertise<tf2_msgs::TFMessage>("/tf");
  const std::string name = newName();
  DiagnosticsProbe diagnostics(name);
  ASSERT_TRUE(tryLoad(name, "TrackerNodelet"));
  const auto input = advertise<PanopticCloud>(name + "/input");
  Probe<ObjectArray> objects(name + "/objects");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  ASSERT_TRUE(eventually([&] { return output.subscriber().getNumPublishers() > 0; }));
  ASSERT_TRUE(eventually([&] { return objects.subscriber().getNumPublishers() > 0; }));
  ASSERT_TRUE(eventually([&] { return tf.getNumSubscribers() > 0; }));
  const auto send = [&](const boost::shared_ptr<PanopticCloud>& cloud)
  {
    input.publish(boost::shared_ptr<const PanopticCloud>(cloud));
    return std::make_pair(objects.next(), output.next());
  };
  std::set<std::uint32_t> ids;
  for (const double seconds : {0.0, 0.1, 0.2})
  {
    tf.publish(streetTransform(seconds));
    const auto [list, cloud] = send(streetScan(seconds, 1, 2));
    ASSERT_TRUE(list && cloud);
    for (const Object& object : list->objects) ids.insert(object.track_id);
  }
  EXPECT_EQ(ids, (std::set<std::uint32_t>{1, 2}));

  const auto bad = streetScan(0.3, 1, 2);
  GetParam().spoil(*bad);
  const auto [list, cloud] = send(bad);
  ASSERT_TRUE(list && cloud) << "the scan is lost";
  EXPECT_EQ(cloud->points.size(), bad->points.size());
  std::size_t seen = 0;
  for (const Object& object : list->objects) seen += object.points > 0 ? 1 : 0;
  EXPECT_EQ(seen, GetParam().objects);
  if (GetParam().word[0] != '\0')
  {
    const auto report = diagnostics.waitFor("level", "1");
    EXPECT_NE(report.at("message").find(GetParam().word), std::string::npos) << report.at("message");
  }
  tf.publish(streetTransform(0.4));
  const auto [next_list, next_cloud] = send(streetScan(0.4, 1, 2));
  ASSERT_TRUE(next_list && next_cloud);
  EXPECT_EQ(next_cloud->points.size(), 481U);
  std::size_t known = 0;
  for (const Object& object : next_list->objects) known += object.points == 240 ? 1 : 0;
  EXPECT_EQ(known, 2U);
}

class TrackerInput : public Graph
{
};

TEST_F(TrackerInput, WithoutInstancesIsRefusedByName)
{
  LogProbe log;
  const std::string name = load("TrackerNodelet");
  const auto input = advertise<sensor_msgs::PointCloud2>(name + "/input");
  Probe<ObjectArray> objects(name + "/objects");
  waitForSubscriber(input);
  sensor_msgs::PointCloud2 message;
  pcl::toROSMsg(*streetScan(0.0, 1, 2), message);
  for (auto& field : message.fields)
    if (field.name == "instance") field.name = "id";
  input.publish(message);
  log.waitFor("expected a field 'instance'");
  pcl::toROSMsg(*streetScan(0.1, 1, 2), message);
  input.publish(message);
  const auto list = objects.next();
  ASSERT_TRUE(list);
  EXPECT_EQ(list->objects.size(), 2U);
}

TEST_F(TrackerInput, ParametersOutsideTheirRangeAreRefused)
{
  const std::vector<std::pair<std::string, XmlRpc::XmlRpcValue>> wrong = {
      {"tf_wait_s", -0.1}, {"tf_wait_s", 10.1},      {"max_missed_s", -1.0}, {"max_missed_s", 61.0},
      {"fixed_frame", 3},  {"fixed_frame", "/odom"}, {"vote_over_time", 2},  {"class_table", "nonsense"}};
  for (const auto& [parameter, value] : wrong)
  {
    const std::string name = newName();
    ros::param::set(name + "/" + parameter, value);
    EXPECT_FALSE(tryLoad(name, "TrackerNodelet")) << parameter;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "tracker_bad_input_test");
}
