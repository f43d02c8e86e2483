#include "ros/message_reading.h"

#include <pcl_conversions/pcl_conversions.h>
#include <std_msgs/Header.h>

#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
using ros::serialization::IStream;

/// Reads sensor_msgs/PointCloud2 by its definition up to the points; the view's data stay in the stream's buffer.
RawCloud parseCloud(IStream& stream, std_msgs::Header& header)
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

void parseImage(IStream& stream, sensor_msgs::Image& image)
{
  stream.next(image.header);
  stream.next(image.height);
  stream.next(image.width);
  stream.next(image.encoding);
  stream.next(image.is_bigendian);
  stream.next(image.step);
  std::uint32_t data_size = 0;
  stream.next(data_size);
  const std::uint8_t* data = stream.advance(data_size);
  image.data.assign(data, data + data_size);
}

void parseStatus(IStream& stream, diagnostic_msgs::DiagnosticStatus& status)
{
  stream.next(status.level);
  stream.next(status.name);
  stream.next(status.message);
  stream.next(status.hardware_id);
  std::uint32_t value_count = 0;
  stream.next(value_count);
  for (std::uint32_t i = 0; i < value_count; ++i)
  {
    status.values.emplace_back();
    stream.next(status.values.back());
  }
}

void parseDiagnostics(IStream& stream, diagnostic_msgs::DiagnosticArray& array)
{
  stream.next(array.header);
  std::uint32_t status_count = 0;
  stream.next(status_count);
  for (std::uint32_t i = 0; i < status_count; ++i)
  {
    array.status.emplace_back();
    parseStatus(stream, array.status.back());
  }
}

/// Runs `parse` on the bytes' stream; `type` is for the error.
template <class Parse>
auto parseWhole(std::uint8_t* bytes, std::uint32_t size, const char* type, Parse parse)
{
  IStream stream(bytes, size);
  try
  {
    return parse(stream);
  }
  catch (const ros::serialization::StreamOverrunException&)
  {
    throw std::runtime_error(std::string("expected a whole ") + type + ", found that its " + std::to_string(size) +
                             " bytes end before it does");
  }
}

RawCloud parseWholeCloud(std::uint8_t* bytes, std::uint32_t size, std_msgs::Header& header)
{
  return parseWhole(bytes, size, "sensor_msgs/PointCloud2",
                    [&header](IStream& stream) { return parseCloud(stream, header); });
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

RawImage viewOf(const sensor_msgs::Image& image)
{
  return {image.width,    image.height,      image.step,       image.is_bigendian != 0,
          image.encoding, image.data.data(), image.data.size()};
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, LabelledCloud& cloud)
{
  std_msgs::Header header;
  const RawCloud raw = parseWholeCloud(bytes, size, header);
  readLabelled(raw, LabelledFields(), cloud);
  pcl_conversions::toPCL(header, cloud.header);
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, PanopticCloud& cloud)
{
  std_msgs::Header header;
  const RawCloud raw = parseWholeCloud(bytes, size, header);
  readPanoptic(raw, cloud);
  pcl_conversions::toPCL(header, cloud.header);
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, sensor_msgs::PointCloud2& message)
{
  parseWhole(bytes, size, "sensor_msgs/PointCloud2",
             [&message](IStream& stream)
             {
               const RawCloud raw = parseCloud(stream, message.header);
               stream.next(message.is_dense);
               message.height = raw.height, message.width = raw.width;
               for (const RawField& field : raw.fields)
               {
                 message.fields.emplace_back();
                 message.fields.back().name = field.name;
                 message.fields.back().offset = field.offset;
                 message.fields.back().datatype = field.datatype;
                 message.fields.back().count = field.count;
               }
               message.is_bigendian = raw.is_bigendian ? 1 : 0;
               message.point_step = raw.point_step, message.row_step = raw.row_step;
               message.data.assign(raw.data, raw.data + raw.data_size);
             });
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, sensor_msgs::Image& message)
{
  parseWhole(bytes, size, "sensor_msgs/Image", [&message](IStream& stream) { parseImage(stream, message); });
}

void readSerialized(std::uint8_t* bytes, std::uint32_t size, diagnostic_msgs::DiagnosticArray& message)
{
  parseWhole(bytes, size, "diagnostic_msgs/DiagnosticArray",
             [&message](IStream& stream) { parseDiagnostics(stream, message); });
}
}  // namespace lidar_panoptic_clustering
