#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

namespace lidar_panoptic_clustering
{
/// x, y, z, intensity (float32) of an organised cloud; pixels without a return have NaN coordinates.
sensor_msgs::PointCloud2Ptr unlabelledCloud(const std_msgs::Header& header, const LabelledCloud& cloud);

/// 32FC1: the distance from the sensor [m], NaN where nothing returned, and the intensity as sent; pixel (u, v) is
/// cloud.at(u, v).
sensor_msgs::ImagePtr rangeImage(const std_msgs::Header& header, const LabelledCloud& cloud);
sensor_msgs::ImagePtr intensityImage(const std_msgs::Header& header, const LabelledCloud& cloud);

/// What a network needs of a scan before it is labelled: ~unlabelled, ~range and ~intensity, with the driver's own
/// header. Each is made only while someone listens to it. wanted() may be called from any thread.
class UnlabelledOutputs
{
public:
  void advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status);
  void shutdown();
  bool wanted() const;
  void publish(const std_msgs::Header& header, const LabelledCloud& cloud) const;

private:
  ros::Publisher cloud_, range_, intensity_;
};
}  // namespace lidar_panoptic_clustering
