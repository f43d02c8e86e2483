#include "bags/point_message.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <cstring>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
/// A point of the message, as its bytes lie.
struct Record
{
  ScanPoint point;
  std::uint32_t label;
  std::uint16_t ring, unused;
};
static_assert(sizeof(Record) == 24, "the message's point_step");

void addField(sensor_msgs::PointCloud2& message, const char* name, std::size_t offset, std::uint8_t datatype)
{
  auto& field = message.fields.emplace_back();
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = datatype;
  field.count = 1;
}

void describe(std::size_t points, bool labelled, sensor_msgs::PointCloud2& message)
{
  using Field = sensor_msgs::PointField;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points);
  message.fields.clear();
  addField(message, "x", offsetof(Record, point.x), Field::FLOAT32);
  addField(message, "y", offsetof(Record, point.y), Field::FLOAT32);
  addField(message, "z", offsetof(Record, point.z), Field::FLOAT32);
  addField(message, "intensity", offsetof(Record, point.remission), Field::FLOAT32);
  if (labelled) addField(message, "label", offsetof(Record, label), Field::UINT32);
  addField(message, "ring", offsetof(Record, ring), Field::UINT16);
  message.is_bigendian = 0;
  message.point_step = sizeof(Record);
  message.row_step = static_cast<std::uint32_t>(points * sizeof(Record));
  message.is_dense = 0;
}
}  // namespace

void toPointMessage(const std::vector<ScanPoint>& scan, const Projection& projection,
                    const std::vector<std::uint32_t>& labels, sensor_msgs::PointCloud2& message)
{
  if (projection.pixel_of_point.size() != scan.size() || (!labels.empty() && labels.size() != scan.size()))
    throw std::invalid_argument("expected a pixel and a label for each of " + std::to_string(scan.size()) +
                                " points, found " + std::to_string(projection.pixel_of_point.size()) + " pixels and " +
                                std::to_string(labels.size()) + " labels");
  describe(scan.size(), !labels.empty(), message);
  message.data.resize(scan.size() * sizeof(Record));
  const std::uint32_t columns = projection.cloud.width, last_row = projection.cloud.height - 1;
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    Record record{scan[i], labels.empty() ? 0 : rawClass(labels[i]), 0, 0};
    record.ring = static_cast<std::uint16_t>(last_row - projection.pixel_of_point[i] / columns);
    std::memcpy(&message.data[i * sizeof(Record)], &record, sizeof record);
  }
}
}  // namespace lidar_panoptic_clustering
