#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <Eigen/Geometry>

#include <string>

namespace lidar_panoptic_clustering
{
/// A sensor's pose in the frame "world" as tf wants it.
inline geometry_msgs::TransformStamped transformOf(const Eigen::Isometry3d& pose, const std::string& frame_id,
                                                   const ros::Time& stamp)
{
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = "world";
  transform.child_frame_id = frame_id;
  const Eigen::Quaterniond rotation(pose.linear());
  transform.transform.translation.x = pose.translation().x();
  transform.transform.translation.y = pose.translation().y();
  transform.transform.translation.z = pose.translation().z();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}
}  // namespace lidar_panoptic_clustering
