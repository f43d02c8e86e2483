#pragma once

#include <lidar_panoptic_clustering/ObjectArray.h>
#include <ros/ros.h>

#include <cstdint>
#include <string>

namespace lidar_panoptic_clustering
{
/// The topics of a nodelet's object list: ~objects, and ~detections where the package was built beside vision_msgs.
///
/// vision_msgs/Detection3DArray of ROS 1 has no track id, no speed and no class name: a detection is a box with one
/// hypothesis, whose id is the class id, whose score is the share of the points that agree, and whose pose is the box's
/// with its covariance. Objects that are not seen in the scan are no detections.
class ObjectOutputs
{
public:
  /// Whether ~detections is there.
  static bool hasDetections();

  void advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status);
  void shutdown();
  /// How many listen. What nobody listens to is not made.
  std::uint32_t listeners() const { return objects_.getNumSubscribers() + detections_.getNumSubscribers(); }
  std::string topic() const { return objects_.getTopic(); }  ///< full name of ~objects
  /// Goes out by pointer, and must not be changed any more.
  void publish(const ObjectArrayConstPtr& list);

private:
  ros::Publisher objects_, detections_;
};
}  // namespace lidar_panoptic_clustering
