#pragma once

#include "lidar_panoptic_clustering/drawing/scan_figure.h"

#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <optional>
#include <string>

namespace lidar_panoptic_clustering
{
/// Boxes, names and ways of the newest scan of trackers, for a picture. The names are those of objects that move.
class TrackedPictures
{
public:
  /// Listens to the outputs of the tracker behind `algorithm`.
  void listen(ros::NodeHandle& nh, const std::string& algorithm);
  void stop();
  /// Nothing where no scan came. Valid until the next call of spinning.
  std::optional<ScanPanel> panel(const std::string& algorithm) const;

private:
  using CloudPtr = boost::shared_ptr<const PanopticCloud>;
  struct Scan
  {
    CloudPtr newest, cloud;  ///< `cloud` is that of the markers
    visualization_msgs::MarkerArrayConstPtr markers;
  };

  void receive(Scan& scan, const visualization_msgs::MarkerArrayConstPtr& markers);

  std::map<std::string, Scan> scans_;  ///< by algorithm
  std::vector<ros::Subscriber> subscribers_;
};
}  // namespace lidar_panoptic_clustering
