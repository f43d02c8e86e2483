#include "graph_fixture.h"
#include "labelled_scene.h"

#include <pcl_conversions/pcl_conversions.h>
#include <pcl_ros/point_cloud.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

const char* const kOtherProcessTopic = "/other_process/scan";

/// Publishes the scene in a layout of its own until ROS ends: the other process of the tests.
int runSender(int argc, char** argv)
{
  ros::init(argc, argv, "sender");
  ros::NodeHandle nh;
  const auto publisher = nh.advertise<sensor_msgs::PointCloud2>(kOtherProcessTopic, 1);
  const auto message = toRosMessage(laidOut(labelledScene(), kOddLayout));
  for (ros::WallRate rate(20.0); ros::ok(); rate.sleep()) publisher.publish(message);
  return 0;
}

void expectClustered(const PanopticCloud& out, const LabelledCloud& in, const std::string& algorithm)
{
  EXPECT_EQ(out.width, in.width);
  EXPECT_EQ(out.height, in.height);
  EXPECT_EQ(out.header.frame_id, in.header.frame_id);
  EXPECT_EQ(out.header.stamp, in.header.stamp);
  const auto expected = instancesOf(runAlgorithm(algorithm, in));
  ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 3U);
  EXPECT_EQ(instancesOf(out), expected);
  ASSERT_EQ(out.points.size(), in.points.size());
  for (std::size_t i = 0; i < in.points.size(); ++i)
  {
    EXPECT_EQ(out.points[i].label, in.points[i].label);
    EXPECT_TRUE(std::isnan(in.points[i].x) || std::memcmp(out.points[i].data, in.points[i].data, 12) == 0) << i;
  }
}

class EachClusterNodelet : public Graph, public testing::WithParamInterface<std::pair<std::string, std::string>>
{
};
INSTANTIATE_TEST_SUITE_P(Algorithms, EachClusterNodelet, testing::ValuesIn(clusterNodelets()),
                         [](const auto& instance) { return instance.param.first; });

/// A cloud's sensor_origin_ stands in no message: it arrives only where the object itself is handed on, and leaves
/// the nodelet only where its own object is.
TEST_P(EachClusterNodelet, HandsOnPointers)
{
  const auto [algorithm, type] = GetParam();
  const std::string name = load(type);
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  LabelledCloud cloud = labelledScene();
  cloud.sensor_origin_ = Eigen::Vector4f(1.0F, 2.0F, 3.0F, 4.0F);
  input.publish(share(cloud));

  const auto out = output.next();
  ASSERT_TRUE(out);
  expectClustered(*out, cloud, algorithm);
  EXPECT_EQ(out->sensor_origin_, cloud.sensor_origin_);
}

TEST_P(EachClusterNodelet, GivesTheSameIdsToPointsOfAnotherProcess)
{
  const auto [algorithm, type] = GetParam();
  const std::string name = newName();
  ASSERT_TRUE(tryLoad(name, type, {{name + "/input", kOtherProcessTopic}}));
  Probe<PanopticCloud> output(name + "/output");
  const auto out = output.next();
  ASSERT_TRUE(out) << "no scan from the sender's process";
  expectClustered(*out, labelledScene(), algorithm);
}

class ClusterNodelet : public Graph
{
};

/// A listener that wants bytes, as another process does, costs its neighbours nothing.
TEST_F(ClusterNodelet, NeighboursShareOneObjectBesideARemoteListener)
{
  const std::string name = load("DepthClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> first(name + "/output"), second(name + "/output");
  Probe<sensor_msgs::PointCloud2> serialised(name + "/output");  // of another type: served with bytes
  waitForSubscriber(input);
  LabelledCloud cloud = labelledScene();
  cloud.sensor_origin_ = Eigen::Vector4f(1.0F, 2.0F, 3.0F, 4.0F);
  ASSERT_TRUE(eventually([&] { return serialised.subscriber().getNumPublishers() > 0; }));
  input.publish(share(cloud));

  const auto a = first.next(), b = second.next();
  const auto bytes = serialised.next();
  ASSERT_TRUE(a && b && bytes);
  EXPECT_EQ(a.get(), b.get());
  EXPECT_EQ(a->sensor_origin_, cloud.sensor_origin_);
  EXPECT_EQ(bytes->width * bytes->height, a->points.size());
  PanopticCloud read;
  pcl::fromROSMsg(*bytes, read);
  expectClustered(read, cloud, "depth");
}

TEST_F(ClusterNodelet, TwoSendersWithTwoLayoutsInOneProcess)
{
  const std::string first = load("DepthClusterNodelet"), second = load("EuclideanClusterNodelet");
  const auto plain = advertise<sensor_msgs::PointCloud2>(first + "/input");
  const auto odd = advertise<sensor_msgs::PointCloud2>(second + "/input");
  Probe<PanopticCloud> of_first(first + "/output"), of_second(second + "/output");
  waitForSubscriber(plain);
  waitForSubscriber(odd);
  const LabelledCloud cloud = labelledScene();
  for (int i = 0; i < 3; ++i)
  {
    plain.publish(toRosMessage(laidOut(cloud, kPlainLayout)));
    odd.publish(toRosMessage(laidOut(cloud, kOddLayout)));
    const auto a = of_first.next(), b = of_second.next();
    ASSERT_TRUE(a && b);
    expectClustered(*a, cloud, "depth");
    expectClustered(*b, cloud, "euclidean");
  }
}

TEST_F(ClusterNodelet, TwoLayoutsOnOneTopic)
{
  const std::string name = load("ScanLineRunClusterNodelet");
  const auto plain = advertise<sensor_msgs::PointCloud2>(name + "/input");
  const auto pointers = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(plain);
  waitForSubscriber(pointers);
  const LabelledCloud cloud = labelledScene();
  for (int i = 0; i < 6; ++i)
  {
    if (i % 3 == 0) plain.publish(toRosMessage(laidOut(cloud, kPlainLayout)));
    if (i % 3 == 1) plain.publish(toRosMessage(laidOut(cloud, kOddLayout)));
    if (i % 3 == 2) pointers.publish(share(cloud));
    const auto out = output.next();
    ASSERT_TRUE(out);
    expectClustered(*out, cloud, "scan_line_run");
  }
}

/// The paint stage's milliseconds of the next scan.
std::string paintMilliseconds(Probe<diagnostic_msgs::DiagnosticArray>& stages, const ros::Publisher& input)
{
  stages.forget();
  input.publish(share(labelledScene()));
  const auto message = stages.next();
  if (!message) return "nothing published";
  for (const auto& item : message->status.at(0).values)
    if (item.key == "paint_ms") return item.value;
  return "no paint_ms";
}

TEST_F(ClusterNodelet, SubscribesAndPaintsOnlyWhileSomeoneListens)
{
  const std::string name = load("DepthClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<diagnostic_msgs::DiagnosticArray> stages(name + "/stages");
  ASSERT_TRUE(eventually([&] { return stages.subscriber().getNumPublishers() > 0; }));
  const auto subscribed = [&] { return input.getNumSubscribers() == 1; };
  const auto unsubscribed = [&] { return input.getNumSubscribers() == 0; };
  ros::WallDuration(0.3).sleep();
  EXPECT_TRUE(unsubscribed());

  for (int i = 0; i < 3; ++i)
  {
    auto markers = std::make_unique<Probe<visualization_msgs::MarkerArray>>(name + "/markers");
    EXPECT_TRUE(eventually(subscribed));
    EXPECT_EQ(paintMilliseconds(stages, input), "0.000000");
    EXPECT_TRUE(markers->next());
    auto output = std::make_unique<Probe<PanopticCloud>>(name + "/output");
    ASSERT_TRUE(eventually([&] { return output->subscriber().getNumPublishers() > 0; }));
    EXPECT_NE(paintMilliseconds(stages, input), "0.000000");
    EXPECT_TRUE(output->next());
    EXPECT_TRUE(markers->next());
    markers.reset();
    paintMilliseconds(stages, input);
    EXPECT_TRUE(output->next());
    EXPECT_TRUE(subscribed());
    output.reset();
    EXPECT_TRUE(eventually(unsubscribed));
  }
}

/// Points every 0.2 m or less around a rectangle of 4 m x 2 m, turned by 30 degrees, about (10, 5), from -1 m to 0.5 m.
void addTurnedCar(LabelledCloud& cloud)
{
  const float c = std::cos(0.5235988F), s = std::sin(0.5235988F);
  for (std::uint32_t row = 0; row < 16; ++row)
    for (std::uint32_t i = 0; i < 64; ++i)
    {
      const float t = 12.0F * static_cast<float>(i) / 60.0F;  // along the outline, corners at 0, 20, 30, 50
      const float u = i > 60 ? 2.0F : t <= 4.0F ? t - 2.0F : t <= 6.0F ? 2.0F : t <= 10.0F ? 8.0F - t : -2.0F;
      const float v = i > 60 ? 0.0F : t <= 4.0F ? -1.0F : t <= 6.0F ? t - 5.0F : t <= 10.0F ? 1.0F : 11.0F - t;
      cloud.points[row * cloud.width + i] =
          labelled(10.0F + c * u - s * v, 5.0F + s * u + c * v, 0.5F - 0.1F * static_cast<float>(row), kMovingCar);
    }
}

TEST_F(ClusterNodelet, MarkersAreTheObjectList)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<visualization_msgs::MarkerArray> markers(name + "/markers");
  waitForSubscriber(input);
  LabelledCloud cloud = emptyCloud(16, 80);
  cloud.header.frame_id = "lidar";
  cloud.header.stamp = 5000000;
  addTurnedCar(cloud);
  cloud.points[70] = labelled(-20.0F, 1.0F, 0.25F, kPerson);
  input.publish(share(cloud));

  const auto array = markers.next();
  ASSERT_TRUE(array);
  ASSERT_EQ(array->markers.size(), 5U);
  EXPECT_EQ(array->markers[0].action, Marker::DELETEALL);
  for (const auto& marker : array->markers)
  {
    EXPECT_EQ(marker.header.frame_id, "lidar");
    EXPECT_EQ(marker.header.stamp, ros::Time(5.0));
  }

  const Marker &car = array->markers[1], &car_text = array->markers[2];
  EXPECT_EQ(car.type, Marker::CUBE);
  EXPECT_EQ(car.id, 1);
  EXPECT_NEAR(car.pose.position.x, 10.0, 1e-4);
  EXPECT_NEAR(car.pose.position.y, 5.0, 1e-4);
  EXPECT_NEAR(car.pose.position.z, -0.25, 1e-4);
  EXPECT_NEAR(car.scale.x, 4.0, 1e-4);
  EXPECT_NEAR(car.scale.y, 2.0, 1e-4);
  EXPECT_NEAR(car.scale.z, 1.5, 1e-4);
  EXPECT_NEAR(2.0 * std::atan2(car.pose.orientation.z, car.pose.orientation.w), 0.5235988, 1e-4);
  EXPECT_EQ(car.pose.orientation.x, 0.0);
  EXPECT_EQ(car.pose.orientation.y, 0.0);
  EXPECT_NEAR(car.color.r, 100.0 / 255.0, 1e-6);  // the class's colour in the table
  EXPECT_NEAR(car.color.g, 150.0 / 255.0, 1e-6);
  EXPECT_NEAR(car.color.b, 245.0 / 255.0, 1e-6);
  EXPECT_EQ(car.text, "car 1: 1024 points");
  EXPECT_EQ(car_text.type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(car_text.text, "car 1: 1024 points");
  EXPECT_GT(car_text.pose.position.z, 0.5);

  const Marker& person = array->markers[3];
  EXPECT_EQ(person.id, 2);
  EXPECT_EQ(person.text, "person 2: 1 points");
  EXPECT_EQ(person.pose.position.x, -20.0);
  EXPECT_FLOAT_EQ(static_cast<float>(person.scale.x), 0.05F);  // as small as RViz shows
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  if (argc > 1 && std::strcmp(argv[1], "--sender") == 0) return lidar_panoptic_clustering::runSender(argc, argv);
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "cluster_nodelet_test");
}
