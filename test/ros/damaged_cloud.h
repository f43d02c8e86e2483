#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstring>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A sensor_msgs/PointCloud2 whose sender breaks off: it goes over the wire without its last bytes.
struct DamagedCloud
{
  sensor_msgs::PointCloud2 message;
  std::uint32_t missing = 10;  ///< bytes
};
}  // namespace lidar_panoptic_clustering

namespace ros
{
namespace message_traits
{
template <>
struct MD5Sum<lidar_panoptic_clustering::DamagedCloud>
{
  static const char* value() { return MD5Sum<sensor_msgs::PointCloud2>::value(); }
  static const char* value(const lidar_panoptic_clustering::DamagedCloud&) { return value(); }
};
template <>
struct DataType<lidar_panoptic_clustering::DamagedCloud>
{
  static const char* value() { return DataType<sensor_msgs::PointCloud2>::value(); }
  static const char* value(const lidar_panoptic_clustering::DamagedCloud&) { return value(); }
};
template <>
struct Definition<lidar_panoptic_clustering::DamagedCloud>
{
  static const char* value() { return Definition<sensor_msgs::PointCloud2>::value(); }
  static const char* value(const lidar_panoptic_clustering::DamagedCloud&) { return value(); }
};
}  // namespace message_traits

namespace serialization
{
template <>
struct Serializer<lidar_panoptic_clustering::DamagedCloud>
{
  template <class Stream>
  static void write(Stream& stream, const lidar_panoptic_clustering::DamagedCloud& cloud)
  {
    std::vector<std::uint8_t> bytes(serializationLength(cloud.message));
    OStream whole(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    serialize(whole, cloud.message);
    const std::uint32_t length = serializedLength(cloud);
    std::memcpy(stream.advance(length), bytes.data(), length);
  }
  static std::uint32_t serializedLength(const lidar_panoptic_clustering::DamagedCloud& cloud)
  {
    return serializationLength(cloud.message) - cloud.missing;
  }
};
}  // namespace serialization
}  // namespace ros
