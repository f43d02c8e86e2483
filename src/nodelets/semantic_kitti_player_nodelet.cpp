#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/datasets/ground_truth_cloud.h"
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "ros/linking.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"
#include "ros/pose_message.h"

#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pcl_ros/point_cloud.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct PlayerConfig
{
  double rate_hz = 10.0;
  bool loop = true;
  int frames = 0;                ///< scans to play, 0 for no end
  int wait_for_subscribers = 1;  ///< of ~output, before the first scan
  std::string on_error = "stop";
  std::string stamps = "now";  ///< or the data set's times, counted from the first scan's
  ProjectionConfig projection;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("rate_hz", self.rate_hz, 0.01, 1000.0);
    visitor("loop", self.loop);
    visitor("frames", self.frames, 0, 2147483647);
    visitor("wait_for_subscribers", self.wait_for_subscribers, 0, 1000);
    visitor("on_error", self.on_error, std::vector<std::string>{"stop", "skip"});
    visitor("stamps", self.stamps, std::vector<std::string>{"now", "dataset"});
    ProjectionConfig::visit(self.projection, visitor);
  }
};

std::string readText(const ros::NodeHandle& nh, const std::string& name, const std::string& default_value)
{
  const ParameterMap given = readParameters(nh, {{name, default_value, 0.0, 0.0, {}}});
  return given.empty() ? default_value : std::get<std::string>(given.begin()->second);
}

/// roslaunch and rosparam make the number 0 of "00".
std::string readSequenceName(const ros::NodeHandle& nh)
{
  int number = 0;
  if (!nh.getParam("sequence", number)) return readText(nh, "sequence", "00");
  char name[16];
  std::snprintf(name, sizeof(name), "%02d", number);
  return name;
}

/// tf2 knows no frame that is empty or begins with a slash.
std::string readFrameId(const ros::NodeHandle& nh)
{
  const auto frame_id = readText(nh, "frame_id", "velodyne");
  if (frame_id.empty() || frame_id.front() == '/')
    throw std::invalid_argument("parameter frame_id must be a name without a leading slash, but is '" + frame_id + "'");
  return frame_id;
}
}  // namespace

/// Plays a sequence of a SemanticKITTI folder, see semantic_kitti.h, as organised clouds.
///
/// ~output: labelled cloud, with the classes of the folder `semantics` (ids of `label_table`), or else the true ones (0
/// where there are none); ~ground_truth: the same pixels with true classes and the data set's own instance ids, which
/// are unique within a class only; tf: world -> frame_id where there are poses. All three carry the same stamp, in
/// whole microseconds, as that is what a PCL header keeps.
class SemanticKittiPlayerNodelet : public nodelet::Nodelet
{
private:
  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    try
    {
      load();
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    auto& nh = getPrivateNodeHandle();
    output_ = advertiseAlone<LabelledCloud>(nh, "output", kQueue);
    ground_truth_ = advertiseAlone<PanopticCloud>(nh, "ground_truth", kQueue);
    {
      const std::lock_guard<std::mutex> lock(linkMutex());
      broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();
    }
    // a wall timer, so that it plays also with use_sim_time while nobody publishes /clock
    timer_ =
        nh.createWallTimer(ros::WallDuration(1.0 / config_.rate_hz), [this](const ros::WallTimerEvent&) { tick(); });
  }

  void load()
  {
    const auto& nh = getPrivateNodeHandle();
    warnOfUnusedParameters(nh, namesOf(describeParameters(config_),
                                       {"frame_id", "class_table", "dataset", "sequence", "semantics", "label_table"}));
    applyParameters(config_, readParameters(nh, describeParameters(config_)));
    frame_id_ = readFrameId(nh);
    table_ = std::make_shared<const ClassTable>(ClassTable::load(readText(nh, "class_table", "semantic_kitti")));
    const auto dataset = readText(nh, "dataset", "");
    if (dataset.empty())
      throw std::invalid_argument("parameter " + nh.resolveName("dataset") +
                                  " must name a folder with sequences/SS/velodyne, but is not set");
    const auto semantics = readText(nh, "semantics", "");
    sequence_ = std::make_unique<SemanticKittiSequence>(dataset, readSequenceName(nh), semantics);
    if (!semantics.empty()) loadPredicted(readText(nh, "label_table", ""));
    poses_ = sequence_->readPoses();
    if (!poses_.empty() && !sequence_->hasCalibration())
      NODELET_WARN(
          "calib.txt of sequence %s has no line 'Tr:': tf neglects how the camera is mounted against the lidar",
          sequence_->name().c_str());
    times_ = sequence_->readTimes();
    if (times_.empty() && config_.stamps == "dataset")
      throw std::invalid_argument("parameter stamps is 'dataset', but sequence " + sequence_->name() +
                                  " has no times.txt");
    projector_ = std::make_unique<PointProjector>(config_.projection);
  }

  void loadPredicted(const std::string& label_table)
  {
    predicted_.emplace(*sequence_, table_, label_table);
    if (!predicted_->doubt().empty()) NODELET_WARN("%s", predicted_->doubt().c_str());
  }

  void tick()
  {
    if (ros::isShuttingDown()) return;  // publishing on what was advertised while ROS ended is fatal
    if (!started_ && output_.getNumSubscribers() < static_cast<std::uint32_t>(config_.wait_for_subscribers)) return;
    started_ = true;
    try
    {
      play(next_);
      ++played_;
    }
    catch (const std::exception& error)
    {
      if (pass_ == 0) NODELET_ERROR("scan %s not played: %s", sequence_->scanName(next_).c_str(), error.what());
      if (config_.on_error == "stop") return stop("because of the error above");
    }
    if (config_.frames > 0 && played_ >= static_cast<std::size_t>(config_.frames))
      return stop("after as many scans as asked for");
    if (++next_ < sequence_->size()) return;
    next_ = 0, ++pass_;
    if (!config_.loop || played_ == 0) stop("at its end");
  }

  void stop(const char* why)
  {
    timer_.stop();
    NODELET_INFO("stopped %s: played %zu scans of sequence %s", why, played_, sequence_->name().c_str());
  }

  void play(std::size_t scan)
  {
    sequence_->readScan(scan, points_);
    truth_.clear();
    if (sequence_->hasLabels()) sequence_->readLabels(scan, points_.size(), truth_);
    if (predicted_) predicted_->read(*sequence_, scan, points_.size(), predictions_);
    projector_->project(points_, predicted_ ? predictions_ : truth_, projection_);

    pcl::PCLHeader header;
    header.frame_id = frame_id_;
    header.stamp = nextStamp(scan);
    if (!poses_.empty())
      broadcaster_->sendTransform(transformOf(poses_[scan], frame_id_, pcl_conversions::fromPCL(header.stamp)));
    if (!truth_.empty() && ground_truth_.getNumSubscribers() > 0)
    {
      const PanopticCloud::Ptr cloud(new PanopticCloud);
      paintGroundTruth(projection_, truth_, *table_, *cloud);
      cloud->header = header;
      ground_truth_.publish(pcl::ros_ptr(cloud));
    }
    const LabelledCloud::Ptr cloud(new LabelledCloud);
    cloud->swap(projection_.cloud);
    cloud->header = header;
    output_.publish(pcl::ros_ptr(cloud));
  }

  /// [us]; after the last one, whatever the clock does.
  std::uint64_t nextStamp(std::size_t scan)
  {
    std::uint64_t stamp = 0;
    pcl_conversions::toPCL(ros::Time::now(), stamp);
    if (config_.stamps == "dataset")
    {
      if (first_stamp_ == 0) first_stamp_ = stamp;
      const double pass_length = times_.back() - times_.front() + 1.0 / config_.rate_hz;
      const double elapsed = times_[scan] - times_.front() + static_cast<double>(pass_) * pass_length;
      stamp = first_stamp_ + static_cast<std::uint64_t>(std::llround(elapsed * 1e6));
    }
    last_stamp_ = std::max(stamp, last_stamp_ + 1);
    return last_stamp_;
  }

  static constexpr std::uint32_t kQueue = 10;  ///< so that a subscriber in another process misses none at a hiccup

  PlayerConfig config_;
  std::string frame_id_;
  std::shared_ptr<const ClassTable> table_;
  std::unique_ptr<SemanticKittiSequence> sequence_;
  std::unique_ptr<PointProjector> projector_;
  std::optional<PredictedClasses> predicted_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> times_;

  bool started_ = false;
  std::size_t next_ = 0, pass_ = 0, played_ = 0;
  std::uint64_t first_stamp_ = 0, last_stamp_ = 0;
  std::vector<ScanPoint> points_;
  std::vector<std::uint32_t> truth_, predictions_;
  Projection projection_;

  ros::Publisher output_, ground_truth_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::WallTimer timer_;  // last: stops before what its callback uses goes
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::SemanticKittiPlayerNodelet, nodelet::Nodelet)
