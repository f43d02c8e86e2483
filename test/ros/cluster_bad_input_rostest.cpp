#include "graph_fixture.h"
#include "labelled_scene.h"

#include <pcl_ros/point_cloud.h>
#include <visualization_msgs/MarkerArray.h>

#include <functional>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
struct BadMessage
{
  const char* name;
  std::function<void(sensor_msgs::PointCloud2&)> spoil;
  const char* error;  ///< part of it
};

void renameField(sensor_msgs::PointCloud2& m, const std::string& from, const std::string& to)
{
  for (auto& field : m.fields)
    if (field.name == from) field.name = to;
}

const std::vector<BadMessage>& badMessages()
{
  using Message = sensor_msgs::PointCloud2;
  static const std::vector<BadMessage> list = {
      {"Unorganised",
       [](Message& m)
       {
         m.width *= m.height;
         m.row_step *= m.height;
         m.height = 1;
       },
       "found one row of 512 points"},
      {"NoLabel", [](Message& m) { renameField(m, "label", "class"); }, "expected a field 'label'"},
      {"NoZ", [](Message& m) { renameField(m, "z", "height"); }, "expected a field 'z'"},
      {"DataTooShort", [](Message& m) { m.data.resize(m.data.size() - 100); }, "bytes"},
      {"BigEndian", [](Message& m) { m.is_bigendian = 1; }, "is_bigendian"},
      {"OffsetOutsideThePoint", [](Message& m) { m.fields[1].offset = m.point_step - 1; }, "inside the point of"},
      {"HugeOffset", [](Message& m) { m.fields[2].offset = 0xFFFFFFFF; }, "inside the point of"},
      {"HugeSize", [](Message& m) { m.width = m.height = 0xFFFFFFFF; }, "expected"},
      {"RowsTooShort", [](Message& m) { m.row_step = 1; }, "expected"},
      {"UnknownDatatype", [](Message& m) { m.fields[0].datatype = 77; }, "expected"},
      {"NoPointStep", [](Message& m) { m.point_step = 0; }, "expected"},
      {"NoFields", [](Message& m) { m.fields.clear(); }, "expected a field"},
  };
  return list;
}

class BadInput : public Graph, public testing::WithParamInterface<BadMessage>
{
};
INSTANTIATE_TEST_SUITE_P(Messages, BadInput, testing::ValuesIn(badMessages()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(BadInput, IsDroppedWithItsReasonAndTheNextScanIsProcessed)
{
  LogProbe log;
  const std::string name = load("DepthClusterNodelet");
  DiagnosticsProbe diagnostics(name);
  const auto input = advertise<sensor_msgs::PointCloud2>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  const LabelledCloud cloud = labelledScene();
  const auto good = toRosMessage(laidOut(cloud, kPlainLayout));
  const auto bad = boost::make_shared<sensor_msgs::PointCloud2>(*good);
  GetParam().spoil(*bad);

  input.publish(bad);
  const std::string message = log.waitFor("dropped");
  EXPECT_NE(message.find(name + "/input"), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().error), std::string::npos) << message;
  auto report = diagnostics.waitFor("scans refused", "1");
  EXPECT_EQ(report["level"], std::to_string(diagnostic_msgs::DiagnosticStatus::ERROR));
  EXPECT_EQ(report["last error"], message);
  EXPECT_EQ(report["scans processed"], "0");
  EXPECT_FALSE(output.takeIfThere());

  input.publish(good);
  const auto out = output.next();
  ASSERT_TRUE(out);
  EXPECT_EQ(instancesOf(*out), instancesOf(runAlgorithm("depth", cloud)));
  report = diagnostics.waitFor("scans processed", "1");
  EXPECT_EQ(report["level"], std::to_string(diagnostic_msgs::DiagnosticStatus::OK));
  EXPECT_EQ(report["scans refused"], "1");
  EXPECT_EQ(report["last error"], message);
}

class BadPoints : public Graph
{
};

TEST_F(BadPoints, CloudOfThisProcessThatContradictsItselfIsDropped)
{
  const std::string name = load("EuclideanClusterNodelet");
  DiagnosticsProbe diagnostics(name);
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  LabelledCloud cloud = labelledScene();
  cloud.points.resize(500);
  input.publish(share(cloud));
  auto report = diagnostics.waitFor("scans refused", "1");
  EXPECT_EQ(report["last error"],
            "cloud on " + name + "/input dropped: cloud is 64 x 8 (width x height) but holds 500 points");
  input.publish(share(labelledScene()));
  EXPECT_TRUE(output.next());
}

/// Coordinates no sensor gives, at things of every column, and one sound car.
LabelledCloud wildScene()
{
  constexpr float kHuge = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kTiny = std::numeric_limits<float>::denorm_min();
  const float values[] = {kNoReturn, kInfinity, -kInfinity, 0.0F, kHuge, -kHuge, kTiny, 1e20F, 299.0F};
  LabelledCloud cloud = twoCars(2.0F);
  std::size_t k = 0;
  for (auto& p : cloud.points)
  {
    if (p.label == kCar) continue;
    p = labelled(values[k % 9], values[k / 9 % 9], values[k / 81 % 9], k % 2 == 0 ? kPerson : kTruck);
    k += 7;
  }
  return cloud;
}

TEST_F(BadPoints, WildCoordinatesAreProcessedByAll)
{
  for (const auto& [algorithm, type] : clusterNodelets())
  {
    SCOPED_TRACE(algorithm);
    const std::string name = load(type);
    const auto input = advertise<LabelledCloud>(name + "/input");
    Probe<PanopticCloud> output(name + "/output");
    Probe<visualization_msgs::MarkerArray> markers(name + "/markers");
    waitForSubscriber(input);
    LabelledCloud cloud = wildScene();
    input.publish(share(cloud));
    const auto out = output.next();
    ASSERT_TRUE(out && markers.next());
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
      EXPECT_TRUE(cloud.points[i].label != kCar || out->points[i].instance > 0) << i;

    for (auto& p : cloud.points) p.x = p.y = p.z = kNoReturn;
    input.publish(share(cloud));
    const auto none = output.next();
    ASSERT_TRUE(none);
    for (const auto& p : none->points) EXPECT_EQ(p.instance, 0U);

    input.publish(share(LabelledCloud()));  // 0 x 0
    const auto empty = output.next();
    ASSERT_TRUE(empty);
    EXPECT_TRUE(empty->points.empty());
  }
}

TEST_F(BadPoints, UnknownClassesAreNoThingsAndWarnedOfOnceEach)
{
  const std::string name = load("DepthClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  Probe<rosgraph_msgs::Log> log("/rosout");
  ASSERT_TRUE(eventually([&] { return log.subscriber().getNumPublishers() > 0; }));
  waitForSubscriber(input);
  LabelledCloud cloud = twoCars(2.0F);
  cloud.points[3] = labelled(5.0F, 0.0F, 0.0F, 7777);
  cloud.points[4] = labelled(5.0F, 0.1F, 0.0F, 0xFFFFFFFF);
  for (int i = 0; i < 3; ++i)
  {
    input.publish(share(cloud));
    const auto out = output.next();
    ASSERT_TRUE(out);
    EXPECT_EQ(out->points[3].instance, 0U);
    EXPECT_EQ(out->points[4].instance, 0U);
    EXPECT_EQ(out->points[4].label, 0xFFFFFFFFU);
    EXPECT_GT(out->points[40].instance, 0U);
  }
  ros::WallDuration(0.5).sleep();
  int of_first = 0, of_second = 0;
  while (const auto message = log.takeIfThere())
  {
    if (message->msg.find("class id 7777 is not in the class table 'semantic_kitti'") == 0) ++of_first;
    if (message->msg.find("class id 4294967295 is not in") == 0) ++of_second;
  }
  EXPECT_EQ(of_first, 1);
  EXPECT_EQ(of_second, 1);
}

TEST_F(BadPoints, DiagnosticsTellRateAndStages)
{
  const std::string name = load("ScanLineRunClusterNodelet");
  DiagnosticsProbe diagnostics(name);
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  for (int i = 0; i < 5; ++i)
  {
    input.publish(share(labelledScene()));
    ASSERT_TRUE(output.next());
  }
  auto report = diagnostics.waitFor("scans processed", "5");
  EXPECT_EQ(report["input"], "by pointer from " + ros::this_node::getName());
  for (const char* stage : {"select", "cluster", "refine", "paint"})
    EXPECT_EQ(report.count(std::string(stage) + " [ms]"), 1U) << stage;
  EXPECT_GT(std::stod(report["rate [Hz]"]), 0.0);
  EXPECT_EQ(report["scans dropped"], "0");
  EXPECT_EQ(report["last error"], "none");
  const std::string idle = "no input: nothing comes on " + name + "/input, though it has 1 publisher";
  EXPECT_EQ(diagnostics.waitFor("message", idle)["rate [Hz]"], "0.00");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "cluster_bad_input_test");
}
