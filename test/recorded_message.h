#pragma once

#include "raw_message.h"

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
/// A recorded cloud as it would be sent, with a label added: its pixel's number, modulo 251.
inline RawMessage recordedMessage(const std::string& file)
{
  pcl::PCLPointCloud2 cloud;
  if (pcl::io::loadPCDFile(file, cloud) != 0) throw std::runtime_error("cannot read " + file);
  std::vector<RawField> fields;
  for (const auto& field : cloud.fields) fields.push_back({field.name, field.offset, field.datatype, field.count});
  fields.push_back(rawField("label", cloud.point_step, NumberType::kUint8));
  RawMessage message(cloud.height, cloud.width, fields, cloud.point_step + 1);
  for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i)
  {
    std::uint8_t* to = &message.bytes[i * message.header.point_step];
    std::memcpy(to, &cloud.data[i * cloud.point_step], cloud.point_step);
    to[cloud.point_step] = static_cast<std::uint8_t>(i % 251);
  }
  return message;
}

/// The last row first.
inline RawMessage upsideDown(const RawMessage& message)
{
  RawMessage result = message;
  const std::size_t step = message.header.row_step, height = message.header.height;
  for (std::size_t row = 0; row < height; ++row)
    std::memcpy(&result.bytes[row * step], &message.bytes[(height - 1 - row) * step], step);
  return result;
}
}  // namespace lidar_panoptic_clustering
