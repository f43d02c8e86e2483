#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"
#include "lidar_panoptic_clustering/projection/separate_labels.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <pcl_ros/point_cloud.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstdint>

namespace lidar_panoptic_clustering
{
/// What errors call a message of a type.
template <class Message>
constexpr const char* kMessageNoun = "cloud";
template <>
inline constexpr const char* kMessageNoun<sensor_msgs::Image> = "image";
template <>
inline constexpr const char* kMessageNoun<diagnostic_msgs::DiagnosticArray> = "message";

/// A view of the message; it must outlive the view.
RawCloud viewOf(const sensor_msgs::PointCloud2& message);
RawImage viewOf(const sensor_msgs::Image& image);

/// Turns the bytes of a serialised sensor_msgs/PointCloud2 into a cloud, header included (the stamp to PCL's
/// microsecond). The points are read where they lie, without a PointCloud2 in between. Throws std::exception's
/// descendants that say what was expected and what was found.
void readSerialized(std::uint8_t* bytes, std::uint32_t size, LabelledCloud& cloud);
void readSerialized(std::uint8_t* bytes, std::uint32_t size, PanopticCloud& cloud);

/// Likewise for messages that stay what they are. What their counts promise beyond the bytes there are is refused
/// before memory is taken for it. What clouds and images say of themselves is left to their readers.
void readSerialized(std::uint8_t* bytes, std::uint32_t size, sensor_msgs::PointCloud2& message);
void readSerialized(std::uint8_t* bytes, std::uint32_t size, sensor_msgs::Image& message);
void readSerialized(std::uint8_t* bytes, std::uint32_t size, diagnostic_msgs::DiagnosticArray& message);
}  // namespace lidar_panoptic_clustering
