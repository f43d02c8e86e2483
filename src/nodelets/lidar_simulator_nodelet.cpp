#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "ros/linking.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <geometry_msgs/TransformStamped.h>
#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pcl_ros/point_cloud.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <pluginlib/class_list_macros.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
struct NodeletConfig
{
  int frames = 0;  ///< scans to publish, 0 for no end

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("frames", self.frames, 0, 2147483647);
  }
};

template <class Config>
Config readConfig(const ros::NodeHandle& nh)
{
  Config config;
  applyParameters(config, readParameters(nh, describeParameters(config)));
  return config;
}

std::string readName(const ros::NodeHandle& nh, const std::string& name, const std::string& otherwise)
{
  const ParameterMap given = readParameters(nh, {ParameterInfo{name, otherwise, 0.0, 0.0, {}}});
  return given.empty() ? otherwise : std::get<std::string>(given.begin()->second);
}

/// tf2 knows no frame that is empty or begins with a slash.
std::string readFrameId(const ros::NodeHandle& nh)
{
  const std::string frame_id = readName(nh, "frame_id", "lidar");
  if (frame_id.empty() || frame_id.front() == '/')
    throw std::invalid_argument("parameter " + nh.resolveName("frame_id") +
                                ": expected a name without a leading slash, got '" + frame_id + "'");
  return frame_id;
}

geometry_msgs::TransformStamped transformOf(const simulation::Pose& pose, const std::string& frame_id, ros::Time stamp)
{
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = "world";
  transform.child_frame_id = frame_id;
  transform.transform.translation.x = pose.x;
  transform.transform.translation.y = pose.y;
  transform.transform.translation.z = pose.z;
  transform.transform.rotation.z = std::sin(0.5 * pose.yaw);
  transform.transform.rotation.w = std::cos(0.5 * pose.yaw);
  return transform;
}
}  // namespace

/// Publishes what a simulated lidar sees on its way down a street, in real time.
///
/// ~output: labelled cloud; ~ground_truth: the same with true instances; tf: world -> frame_id. Scans are made only
/// while someone listens; the drive goes on meanwhile. ~sensor: a sensor that ships with the package, or a YAML file.
class LidarSimulatorNodelet : public nodelet::Nodelet
{
private:
  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    auto& nh = getPrivateNodeHandle();
    try
    {
      warnOfUnusedParameters(nh, namesOf(describeParameters(SimulatorConfig()), {"frames", "frame_id", "sensor"}));
      frames_ = readConfig<NodeletConfig>(nh).frames;
      frame_id_ = readFrameId(nh);
      simulator_ = std::make_unique<LidarSimulator>(SensorModel::load(readName(nh, "sensor", "hdl64e")),
                                                    readConfig<SimulatorConfig>(nh));
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    output_ = advertiseAlone<LabelledCloud>(nh, "output", 2);
    ground_truth_ = advertiseAlone<PanopticCloud>(nh, "ground_truth", 2);
    {
      const std::lock_guard<std::mutex> lock(linkMutex());
      broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();
    }
    // a wall timer, so that it drives also with use_sim_time while nobody publishes /clock
    timer_ = nh.createWallTimer(ros::WallDuration(1.0 / simulator_->config().rate_hz),
                                [this](const ros::WallTimerEvent&) { tick(); });
  }

  void tick()
  {
    if (ros::isShuttingDown()) return;  // publishing on what was advertised while ROS ended is fatal
    if (frames_ > 0 && published_ >= frames_) return timer_.stop();
    const std::uint64_t frame = frame_++;
    pcl::PCLHeader header;
    header.frame_id = frame_id_;
    pcl_conversions::toPCL(ros::Time::now(), header.stamp);
    broadcaster_->sendTransform(
        transformOf(simulator_->pose(frame), frame_id_, pcl_conversions::fromPCL(header.stamp)));

    const bool labelled = output_.getNumSubscribers() > 0, panoptic = ground_truth_.getNumSubscribers() > 0;
    if (!labelled && !panoptic) return;
    const PanopticCloud::Ptr truth(new PanopticCloud);
    truth->header = header;
    simulator_->scan(frame, *truth);
    if (labelled) publishLabelled(*truth);
    if (panoptic) ground_truth_.publish(pcl::ros_ptr(truth));
    ++published_;
  }

  void publishLabelled(const PanopticCloud& truth)
  {
    const LabelledCloud::Ptr cloud(new LabelledCloud(truth.width, truth.height));
    cloud->header = truth.header;
    cloud->is_dense = truth.is_dense;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
      auto& point = cloud->points[i];
      point.getVector4fMap() = truth.points[i].getVector4fMap();
      point.intensity = truth.points[i].intensity;
      point.label = truth.points[i].label;
    }
    output_.publish(pcl::ros_ptr(cloud));
  }

  int frames_ = 0, published_ = 0;
  std::uint64_t frame_ = 0;
  std::string frame_id_;
  std::unique_ptr<LidarSimulator> simulator_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::Publisher output_, ground_truth_;
  ros::WallTimer timer_;  // last: stops before what its callback uses goes
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::LidarSimulatorNodelet, nodelet::Nodelet)
