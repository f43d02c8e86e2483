#pragma once

#include <lidar_panoptic_clustering/ObjectArray.h>
#include <ros/ros.h>

namespace lidar_panoptic_clustering::detections
{
/// Whether vision_msgs was there when this was built; nothing is advertised otherwise.
bool isBuilt();
ros::Publisher advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status);
void publish(ros::Publisher& publisher, const ObjectArray& list);
}  // namespace lidar_panoptic_clustering::detections
