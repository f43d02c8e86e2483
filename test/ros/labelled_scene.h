#pragma once

#include "raw_message.h"
#include "scan_fixture.h"

#include <sensor_msgs/PointCloud2.h>

#include <cctype>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The nodelet that runs an algorithm, named as cluster.launch does it: scan_line_run, ScanLineRunClusterNodelet.
inline std::string clusterNodelet(const std::string& algorithm)
{
  std::string name;
  bool begins = true;
  for (const char c : algorithm)
  {
    if (c != '_') name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = std::isalpha(static_cast<unsigned char>(c)) == 0;
  }
  return name + "ClusterNodelet";
}

/// All algorithms and the nodelets that run them.
inline const std::vector<std::pair<std::string, std::string>>& clusterNodelets()
{
  static const auto list = []
  {
    std::vector<std::pair<std::string, std::string>> names;
    for (const std::string& algorithm : algorithmNames()) names.emplace_back(algorithm, clusterNodelet(algorithm));
    return names;
  }();
  return list;
}

/// A scan of 8 x 64 pixels with a dozen objects, and a header.
inline LabelledCloud labelledScene(std::uint64_t stamp = 1700000000123456)
{
  LabelledCloud cloud = randomScan(3, 8, 64);
  cloud.header.frame_id = "lidar";
  cloud.header.stamp = stamp;
  return cloud;
}

/// Two cars `gap_m` apart, each a line of 8 points 0.1 m from one another, in two rows.
inline LabelledCloud twoCars(float gap_m)
{
  LabelledCloud cloud = emptyCloud(2, 64);
  for (std::uint32_t row = 0; row < 2; ++row)
    for (std::uint32_t i = 0; i < 8; ++i)
    {
      const float y = 0.1F * static_cast<float>(i), z = -0.1F * static_cast<float>(row);
      cloud.points[row * 64 + 40 - i] = labelled(10.0F, y, z, kCar);
      cloud.points[row * 64 + 20 - i] = labelled(10.0F, y + 0.7F + gap_m, z, kCar);
    }
  cloud.header.frame_id = "lidar";
  return cloud;
}

inline boost::shared_ptr<const LabelledCloud> share(const LabelledCloud& cloud)
{
  return boost::make_shared<LabelledCloud>(cloud);
}

inline sensor_msgs::PointCloud2Ptr toRosMessage(const RawMessage& raw, const std::string& frame_id = "lidar",
                                                ros::Time stamp = ros::Time(1700000000, 123456000))
{
  const auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header.frame_id = frame_id;
  message->header.stamp = stamp;
  message->height = raw.header.height;
  message->width = raw.header.width;
  message->point_step = raw.header.point_step;
  message->row_step = raw.header.row_step;
  message->is_bigendian = raw.header.is_bigendian;
  for (const auto& field : raw.header.fields)
  {
    sensor_msgs::PointField ros_field;
    ros_field.name = field.name;
    ros_field.offset = field.offset;
    ros_field.datatype = field.datatype;
    ros_field.count = field.count;
    message->fields.push_back(ros_field);
  }
  message->data = raw.bytes;
  return message;
}

/// How a sender lays out its points.
struct PointLayout
{
  NumberType coordinates, label;
  bool label_first;
  std::uint32_t row_padding;
};
constexpr PointLayout kPlainLayout{NumberType::kFloat32, NumberType::kUint32, false, 0};
constexpr PointLayout kOddLayout{NumberType::kFloat64, NumberType::kUint16, true, 5};

/// The points of a cloud in a layout of one's own.
inline RawMessage laidOut(const LabelledCloud& cloud, const PointLayout& layout)
{
  std::uint32_t step = 0;
  const NumberType coordinates = layout.coordinates, label = layout.label;
  auto fields = layout.label_first
                    ? packed({{"label", label}, {"z", coordinates}, {"x", coordinates}, {"y", coordinates}}, step)
                    : packed({{"x", coordinates}, {"y", coordinates}, {"z", coordinates}, {"label", label}}, step);
  RawMessage raw(cloud.height, cloud.width, std::move(fields), step, layout.row_padding);
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column)
    {
      const LabelledPoint& p = cloud.points[row * cloud.width + column];
      raw.setPoint(row, column, p.x, p.y, p.z);
      raw.set(row, column, "label", p.label);
    }
  return raw;
}
}  // namespace lidar_panoptic_clustering
