#pragma once

#include "lidar_panoptic_clustering/projection/original_cloud.h"

#include <sensor_msgs/PointCloud2.h>

namespace lidar_panoptic_clustering
{
/// The message of a cloud with fields added, with the header, width and height of what was sent. Takes the data of
/// `cloud`.
sensor_msgs::PointCloud2Ptr toMessage(OriginalCloud& cloud, const sensor_msgs::PointCloud2& sent);
}  // namespace lidar_panoptic_clustering
