#include "graph_fixture.h"
#include "labelled_scene.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <nodelet/NodeletList.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <pcl_ros/point_cloud.h>
#include <visualization_msgs/MarkerArray.h>

#include <atomic>
#include <memory>
#include <thread>

namespace lidar_panoptic_clustering
{
namespace
{
class ClusterLifecycle : public Graph
{
};

/// What `nodelet load TYPE MANAGER` and `nodelet unload NAME MANAGER` ask of a manager.
struct ManagerClient
{
  std::string manager;

  bool load(const std::string& name, const std::string& type) const
  {
    nodelet::NodeletLoad service;
    service.request.name = name;
    service.request.type = "lidar_panoptic_clustering/" + type;
    return ros::service::call(manager + "/load_nodelet", service) && service.response.success != 0;
  }
  bool unload(const std::string& name) const
  {
    nodelet::NodeletUnload service;
    service.request.name = name;
    return ros::service::call(manager + "/unload_nodelet", service) && service.response.success != 0;
  }
  std::size_t count() const
  {
    nodelet::NodeletList service;
    EXPECT_TRUE(ros::service::call(manager + "/list", service));
    return service.response.nodelets.size();
  }
};

TEST_F(ClusterLifecycle, LoadsIntoAnExistingManagerUnloadsAndReloads)
{
  const nodelet::Loader manager{ros::NodeHandle("/manager")};
  const ManagerClient client{"/manager"};
  ASSERT_TRUE(ros::service::waitForService("/manager/list", 10000));
  const LabelledCloud cloud = labelledScene();
  std::vector<std::string> names;
  for (const auto& [algorithm, type] : clusterNodelets())
  {
    names.push_back(newName());
    ASSERT_TRUE(client.load(names.back(), type)) << algorithm;
  }
  EXPECT_FALSE(client.load(names[0], clusterNodelets()[0].second)) << "two nodelets of one name";
  EXPECT_EQ(client.count(), clusterNodelets().size());

  for (int round = 0; round < 2; ++round)
  {
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      const auto& [algorithm, type] = clusterNodelets()[i];
      {
        const auto input = advertise<LabelledCloud>(names[i] + "/input");
        Probe<PanopticCloud> output(names[i] + "/output");
        waitForSubscriber(input);
        input.publish(share(cloud));
        const auto out = output.next();
        ASSERT_TRUE(out) << algorithm;
        EXPECT_EQ(instancesOf(*out), instancesOf(runAlgorithm(algorithm, cloud)));
      }
      EXPECT_TRUE(client.unload(names[i]));
      EXPECT_FALSE(client.unload(names[i]));
      EXPECT_TRUE(client.load(names[i], type));
    }
    EXPECT_EQ(client.count(), clusterNodelets().size());
  }
  for (const auto& name : names) EXPECT_TRUE(client.unload(name));
  EXPECT_EQ(client.count(), 0U);
}

/// Publishes scans, by pointer and by bytes in turn, in a thread of its own.
class Traffic
{
public:
  explicit Traffic(const std::string& topic)
      : by_pointer_(nh_.advertise<LabelledCloud>(topic, 1)),
        by_bytes_(nh_.advertise<sensor_msgs::PointCloud2>(topic, 1)),
        thread_([this] { run(); })
  {
  }
  ~Traffic()
  {
    stop_ = true;
    thread_.join();
  }

private:
  void run()
  {
    const auto cloud = share(labelledScene());
    const auto bytes = toRosMessage(laidOut(*cloud, kOddLayout));
    const auto bad = boost::make_shared<sensor_msgs::PointCloud2>(*bytes);
    bad->is_bigendian = 1;
    for (int i = 0; !stop_; ++i)
    {
      if (i % 3 == 0) by_pointer_.publish(cloud);
      if (i % 3 == 1) by_bytes_.publish(bytes);
      if (i % 3 == 2) by_bytes_.publish(bad);
      ros::WallDuration(0.002).sleep();
    }
  }

  ros::NodeHandle nh_;
  ros::Publisher by_pointer_, by_bytes_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST_F(ClusterLifecycle, UnloadsAndReloadsWhileScansFlow)
{
  Traffic traffic("/traffic/scan");
  const std::string name = newName();
  Probe<PanopticCloud> output(name + "/output");
  Probe<visualization_msgs::MarkerArray> markers(name + "/markers");
  for (int i = 0; i < 12; ++i)
  {
    const auto& [algorithm, type] = clusterNodelets()[i % clusterNodelets().size()];
    ASSERT_TRUE(tryLoad(name, type, {{name + "/input", "/traffic/scan"}})) << algorithm;
    if (i % 3 != 2)  // every third goes at once
    {
      EXPECT_TRUE(output.next()) << algorithm;
      EXPECT_TRUE(markers.next()) << algorithm;
    }
    EXPECT_TRUE(loader_.unload(name));
    EXPECT_TRUE(fallsSilent(output)) << algorithm;
    markers.forget();
  }
}

TEST_F(ClusterLifecycle, ListenersComeAndGoAndParametersChangeWhileScansFlow)
{
  Traffic traffic("/traffic/scan");
  const std::string name = newName();
  ASSERT_TRUE(tryLoad(name, "ScanLineRunClusterNodelet", {{name + "/input", "/traffic/scan"}}));
  Probe<PanopticCloud> steady(name + "/output");
  std::atomic<bool> stop{false};
  std::thread tuner(
      [&]
      {
        for (int i = 0; !stop; ++i)
        {
          dynamic_reconfigure::Reconfigure service;
          service.request.config.ints.resize(1);
          service.request.config.ints[0].name = "max_line_gap";
          service.request.config.ints[0].value = 1 + i % 3;
          EXPECT_TRUE(ros::service::call(name + "/set_parameters", service));
        }
      });
  for (int i = 0; i < 20; ++i)
  {
    Probe<PanopticCloud> output(name + "/output");
    Probe<visualization_msgs::MarkerArray> markers(name + "/markers");
    if (i % 2 == 0)
    {
      EXPECT_TRUE(output.next());
      EXPECT_TRUE(markers.next());
    }
  }
  stop = true;
  tuner.join();
  EXPECT_TRUE(steady.next());
}

/// Many frames too fast for the algorithm: the newest is worked on, the others are dropped and counted.
TEST_F(ClusterLifecycle, NewestScanWinsAndDroppedOnesAreCounted)
{
  const std::string name = load("EuclideanClusterNodelet");
  DiagnosticsProbe diagnostics(name);
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  LabelledCloud cloud = randomScan(1, 64, 1024);
  constexpr std::uint64_t kSent = 200;
  for (std::uint64_t i = 1; i <= kSent; ++i)
  {
    cloud.header.stamp = i;
    input.publish(share(cloud));
  }
  std::uint64_t last = 0, received = 0;
  while (last < kSent)
  {
    const auto out = output.next();
    ASSERT_TRUE(out) << "after " << last;
    EXPECT_GT(out->header.stamp, last);
    last = out->header.stamp, ++received;
  }
  EXPECT_LT(received, kSent) << "nothing was dropped: the test proves nothing";

  const auto report = diagnostics.waitFor("scans processed", std::to_string(received));
  ASSERT_FALSE(report.empty());
  EXPECT_GT(std::stoul(report.at("scans dropped")), 0U);
  EXPECT_LE(std::stoul(report.at("scans dropped")), kSent - received);
  EXPECT_EQ(report.at("scans refused"), "0");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "cluster_lifecycle_test");
}
