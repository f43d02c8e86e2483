#pragma once

#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"
#include "ros/fixed_frame.h"
#include "ros/object_nodelet.h"
#include "ros/track_markers.h"

#include <ros/ros.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

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

/// The output of a cluster nodelet -> the same cloud with ids and colours that stay with an object, and ~objects with
/// velocities (see ObjectNodelet).
///
/// Objects are followed in the fixed frame, by tf; where that has none, as seen from the sensor, and the diagnostics
/// say so. A scan waits for its transform until the next one comes, at most tf_wait_s, and takes the latest there is
/// then. Clouds go by pointer. Works only on the outputs that are listened to.
///
/// Scans without a stamp are taken for those of their arrival. Tracks start anew where time jumps back by more than
/// max_missed_s, and where the transform is there for the first time.
///
/// Parameters: ~class_table, and those of TrackerNodeletConfig.
class TrackerNodelet : public ObjectNodelet<PanopticCloud>
{
public:
  ~TrackerNodelet() override { shutdown(); }

private:
  Work load() override;
  void process(const Scan& scan);
  void stop() override { frame_.stop(); }
  ros::Time timeOf(const Scan& scan);
  Eigen::Isometry3d poseOf(const Scan& scan, ros::Time stamp);
  void startAnewAfterJump(const std::string& frame, ros::Time stamp);
  void startAnew();
  void publishObjects(const PanopticCloud& cloud);
  ObjectArrayPtr makeList(const PanopticCloud& cloud);
  void warnOfUnknownClasses();
  void warn(const char* subject, const std::string& doubt);

  TrackerNodeletConfig config_;
  std::shared_ptr<const ClassTable> table_;
  std::unique_ptr<CloudTracker> tracker_;  ///< the thread's own once it runs, as are the next five
  FixedFrame frame_;
  bool has_pose_ = false;
  ros::Time last_stamp_;
  TrackMarkers marker_list_;
  std::map<std::string, std::string> warned_;  ///< by subject
};
}  // namespace lidar_panoptic_clustering
