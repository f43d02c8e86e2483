#pragma once

#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"
#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"
#include "ros/fixed_frame.h"
#include "ros/latched_input.h"
#include "ros/mailbox.h"
#include "ros/object_outputs.h"
#include "ros/stream_diagnostics.h"
#include "ros/track_markers.h"

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace lidar_panoptic_clustering
{
struct TrackerNodeletConfig
{
  TrackerConfig tracker;
  std::string fixed_frame = "odom";  ///< that objects are followed in; empty: the sensor's, without a warning
  double tf_wait_s = 0.1;            ///< a scan waits so long for its transform

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    TrackerConfig::visit(self.tracker, visitor);
    visitor("fixed_frame", self.fixed_frame, std::vector<std::string>());
    visitor("tf_wait_s", self.tf_wait_s, 0.0, 10.0);
  }
};

/// ~input PanopticCloud of a cluster nodelet -> ~output the same cloud with ids and colours that stay with an object;
/// ~objects the list of them with velocities, which also goes out as ~markers and, where vision_msgs was there, as
/// ~detections; /diagnostics.
///
/// Objects are followed in the fixed frame, by tf; where that has none, as seen from the sensor, and the diagnostics
/// say so. A scan waits for its transform until the next one comes, at most tf_wait_s, and takes the latest there is
/// then. Clouds go by pointer. Subscribes only while someone listens to an output, and works only on those.
///
/// Scans without a stamp are taken for those of their arrival. Tracks start anew where time jumps back by more than
/// max_missed_s, and where the transform is there for the first time.
///
/// Parameters: ~class_table, and those of TrackerNodeletConfig.
class TrackerNodelet : public nodelet::Nodelet
{
public:
  ~TrackerNodelet() override;

private:
  using CloudPtr = boost::shared_ptr<const PanopticCloud>;
  struct Scan
  {
    CloudPtr cloud;
    ros::WallTime arrival;
    ros::Time time;
  };

  void onInit() override;
  void load();
  void advertise();
  void connect();
  void receive(const CloudPtr& cloud);
  Idle describeIdle();
  std::uint32_t listeners() const
  {
    return output_.getNumSubscribers() + markers_.getNumSubscribers() + objects_.listeners();
  }
  void work();
  void process(const Scan& scan);
  ros::Time timeOf(const Scan& scan);
  Eigen::Isometry3d poseOf(const Scan& scan, ros::Time stamp);
  void startAnewAfterJump(const std::string& frame, ros::Time stamp);
  void startAnew();
  void publishObjects(const PanopticCloud& cloud);
  ObjectArrayPtr makeList(const PanopticCloud& cloud);
  void warnOfUnknownClasses();
  void warn(const char* subject, const std::string& doubt);
  void refuse(const std::string& error);

  TrackerNodeletConfig config_;
  std::shared_ptr<const ClassTable> table_;
  std::unique_ptr<CloudTracker> tracker_;  ///< the thread's own once it runs, as are the next six
  CloudPool<PanopticCloud> pool_;
  FixedFrame frame_;
  bool has_pose_ = false;
  ros::Time last_stamp_;
  TrackMarkers marker_list_;
  std::map<std::string, std::string> warned_;  ///< by subject
  StreamDiagnostics diagnostics_;

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Publisher output_, markers_;
  ObjectOutputs objects_;
  ros::Subscriber input_;
  LatchedInput<PanopticCloud> latched_;
  Mailbox<Scan> mailbox_;
  std::thread thread_;
};
}  // namespace lidar_panoptic_clustering
