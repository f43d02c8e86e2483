#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

#include <geometry_msgs/TransformStamped.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pcl_ros/point_cloud.h>
#include <ros/time.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include <cstdint>

namespace lidar_panoptic_clustering
{
/// A street as a sensor sees it that drives along x at kSensorMps: a car that stands at (20, 5) and one that drives
/// along x at kCarMps from (10, -4), both 4 m x 2 m. Time is counted from kStart.
constexpr double kSensorMps = 5.0, kCarMps = 8.0;
constexpr std::uint32_t kSceneCar = 10, kScenePerson = 30;
const ros::Time kStart(1700000000, 0);

/// Points every 0.2 m on a car's outline, from -1.5 m to 0 m, in the sensor's frame.
inline void addCar(PanopticCloud& cloud, double x, double y, std::uint32_t instance, std::uint32_t label = kSceneCar)
{
  for (int layer = 0; layer < 4; ++layer)
    for (int i = 0; i < 60; ++i)
    {
      const double t = 0.2 * i;
      PanopticPoint p;
      p.x = static_cast<float>(x + (t < 4.0 ? t - 2.0 : t < 6.0 ? 2.0 : t < 10.0 ? 8.0 - t : -2.0));
      p.y = static_cast<float>(y + (t < 4.0 ? -1.0 : t < 6.0 ? t - 5.0 : t < 10.0 ? 1.0 : 11.0 - t));
      p.z = static_cast<float>(-0.5 * layer);
      p.label = label;
      p.instance = instance;
      cloud.points.push_back(p);
    }
}

/// The scan at `seconds`; ids start anew in each, as a cluster nodelet gives them. One row.
inline boost::shared_ptr<PanopticCloud> streetScan(double seconds, std::uint32_t standing_id, std::uint32_t driving_id)
{
  const auto cloud = boost::make_shared<PanopticCloud>();
  cloud->header.frame_id = "lidar";
  cloud->header.stamp = pcl_conversions::toPCL(kStart + ros::Duration(seconds));
  addCar(*cloud, 20.0 - kSensorMps * seconds, 5.0, standing_id);
  addCar(*cloud, 10.0 + (kCarMps - kSensorMps) * seconds, -4.0, driving_id);
  PanopticPoint road;
  road.x = 3.0F, road.z = -1.7F, road.label = 40, road.rgb = 0x800080;
  cloud->points.push_back(road);
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;
  cloud->sensor_origin_ = Eigen::Vector4f(1.0F, 2.0F, 3.0F, 4.0F);
  return cloud;
}

/// odom -> lidar at that time.
inline tf2_msgs::TFMessage streetTransform(double seconds)
{
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms.front();
  transform.header.stamp = kStart + ros::Duration(seconds);
  transform.header.frame_id = "odom";
  transform.child_frame_id = "lidar";
  transform.transform.translation.x = kSensorMps * seconds;
  transform.transform.rotation.w = 1.0;
  return message;
}
}  // namespace lidar_panoptic_clustering
