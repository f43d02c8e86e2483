#include "reporting/tracked_pictures.h"

#include "ros/cloud_subscription.h"

#include <pcl_conversions/pcl_conversions.h>

#include <cmath>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

std::uint32_t rgbOf(const std_msgs::ColorRGBA& color)
{
  const auto byte = [](float channel) { return static_cast<std::uint32_t>(std::lround(255.0F * channel)); };
  return byte(color.r) << 16U | byte(color.g) << 8U | byte(color.b);
}

NamedBox toBox(const Marker& marker)
{
  NamedBox box;
  box.x = static_cast<float>(marker.pose.position.x), box.y = static_cast<float>(marker.pose.position.y);
  box.length = static_cast<float>(marker.scale.x), box.width = static_cast<float>(marker.scale.y);
  box.yaw = static_cast<float>(2.0 * std::atan2(marker.pose.orientation.z, marker.pose.orientation.w));
  box.rgb = rgbOf(marker.color);
  return box;
}

Trail toTrail(const Marker& marker)
{
  Trail trail;
  trail.rgb = rgbOf(marker.color);
  for (const auto& point : marker.points)
    trail.places.push_back({static_cast<float>(point.x), static_cast<float>(point.y)});
  return trail;
}
}  // namespace

void TrackedPictures::listen(ros::NodeHandle& nh, const std::string& algorithm)
{
  const std::string tracker = algorithm + "_tracker/";
  Scan& scan = scans_[algorithm];
  subscribers_.push_back(subscribeChecked<PanopticCloud>(
      nh, tracker + "output", 10, [&scan](const CloudPtr& cloud) { scan.newest = cloud; },
      [](const std::string& error) { ROS_ERROR("%s", error.c_str()); }));
  ros::SubscribeOptions options;
  options.init<visualization_msgs::MarkerArray>(tracker + "markers", 10,
                                                [this, &scan](const visualization_msgs::MarkerArrayConstPtr& markers)
                                                { receive(scan, markers); });
  subscribers_.push_back(subscribeAlone(nh, options));
}

void TrackedPictures::stop()
{
  for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
}

/// A tracker sends the cloud before the markers.
void TrackedPictures::receive(Scan& scan, const visualization_msgs::MarkerArrayConstPtr& markers)
{
  if (!scan.newest || markers->markers.empty()) return;
  if (pcl_conversions::fromPCL(scan.newest->header.stamp) != markers->markers.front().header.stamp) return;
  scan.cloud = scan.newest, scan.markers = markers;
}

std::optional<ScanPanel> TrackedPictures::panel(const std::string& algorithm) const
{
  const auto found = scans_.find(algorithm);
  if (found == scans_.end() || !found->second.cloud) return std::nullopt;
  const Scan& scan = found->second;
  ScanPanel panel;
  panel.title = algorithm + ", tracked";
  panel.cloud = scan.cloud.get();
  std::set<int> moving;
  for (const Marker& marker : scan.markers->markers)
    if (marker.ns == "velocities" && marker.action == Marker::ADD) moving.insert(marker.id);
  for (const Marker& marker : scan.markers->markers)
  {
    if (marker.action != Marker::ADD) continue;
    if (marker.ns == "boxes") panel.boxes.push_back(toBox(marker));
    if (marker.ns == "trails") panel.trails.push_back(toTrail(marker));
    if (marker.ns == "boxes" && moving.count(marker.id) > 0) panel.boxes.back().text = "#" + std::to_string(marker.id);
  }
  return panel;
}
}  // namespace lidar_panoptic_clustering
