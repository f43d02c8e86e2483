#include "ros/cloud_subscription.h"

#include <pcl_conversions/pcl_conversions.h>
#include <std_msgs/Header.h>

namespace lidar_panoptic_clustering
{
namespace
{
/// Reads sensor_msgs/PointCloud2 by its definition; the view's data stay in the stream's buffer.
RawCloud parseMessage(ros::serialization::IStream& stream, std_msgs::Header& header)
{
  RawCloud cloud;
  stream.next(header);
  stream.next(cloud.height);
  stream.next(cloud.width);

  // field by field, so that a damaged count runs into the stream's end instead of allocating gigabytes
  std::uint32_t field_count = 0;
  stream.next(field_count);
  for (std::uint32_t i = 0; i < field_count; ++i)
  {
    RawField field;
    stream.next(field.name);
    stream.next(field.offset);
    stream.next(field.datatype);
    stream.next(field.count);
    cloud.fields.push_back(std::move(field));
  }

  std::uint8_t is_bigendian = 0;
  stream.next(is_bigendian);
  cloud.is_bigendian = is_bigendian != 0;
  stream.next(cloud.point_step);
  stream.next(cloud.row_step);
  std::uint32_t data_size = 0;
  stream.next(data_size);
  cloud.data = stream.advance(data_size);
  cloud.data_size = data_size;
  return cloud;
}

RawCloud parseWhole(std::uint8_t* bytes, std::uint32_t size, std_msgs::Header& header)
{
  ros::serialization::IStream stream(bytes, size);
  try
  {
    return parseMessage(stream, header);
  }
  catch (const ros::serialization::StreamOverrunException&)
  {
    throw std::runtime_error("expected a whole sensor_msgs/PointCloud2, found that its " + std::to_string(size) +
                             " bytes end before it does");
  }
}
}  // namespace

RawCloud viewOf(const sensor_msgs::PointCloud2& message)
{
  RawCloud cloud;
  cloud.width = message.width;
  cloud.height = message.height;
  cloud.point_step = message.point_step;
  cloud.row_step = message.row_step;
  cloud.is_bigendian = message.is_bigendian != 0;
  cloud.fields.reserve(message.fields.size());
  for (const auto& field : message.fields)
    cloud.fields.push_back({field.name, field.offset, field.datatype, field.count});
  cloud.data = message.data.data();
  cloud.data_size = message.data.size();
  return cloud;
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, LabelledCloud& cloud)
{
  std_msgs::Header header;
  const RawCloud raw = parseWhole(bytes, size, header);
  readLabelled(raw, LabelledFields(), cloud);
  pcl_conversions::toPCL(header, cloud.header);
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, PanopticCloud& cloud)
{
  std_msgs::Header header;
  const RawCloud raw = parseWhole(bytes, size, header);
  readPanoptic(raw, cloud);
  pcl_conversions::toPCL(header, cloud.header);
}
}  // namespace lidar_panoptic_clustering
