#include "ros/instance_markers.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

std_msgs::ColorRGBA toColor(std::uint32_t rgb, float alpha)
{
  const auto channel = [rgb](int shift) { return static_cast<float>(rgb >> shift & 0xFF) / 255.0F; };
  std_msgs::ColorRGBA color;
  color.r = channel(16), color.g = channel(8), color.b = channel(0), color.a = alpha;
  return color;
}
}  // namespace

visualization_msgs::MarkerArray instanceMarkers(const std_msgs::Header& header, const ClassTable& table,
                                                const Instances& instances, const std::vector<InstanceBox>& boxes)
{
  visualization_msgs::MarkerArray array;
  array.markers.reserve(1 + 2 * instances.count());
  array.markers.emplace_back();
  array.markers.back().header = header;
  array.markers.back().action = Marker::DELETEALL;

  for (std::size_t k = 0; k < instances.count(); ++k)
  {
    const auto& object = instances.objects[k];
    const auto& info = table[object.class_index];
    const auto& box = boxes[k];
    Marker marker;
    marker.header = header;
    marker.ns = "boxes";
    marker.id = static_cast<int>(k + 1);
    marker.type = Marker::CUBE;
    marker.action = Marker::ADD;
    marker.pose.position.x = box.x, marker.pose.position.y = box.y, marker.pose.position.z = box.z;
    marker.pose.orientation.z = std::sin(0.5 * box.yaw), marker.pose.orientation.w = std::cos(0.5 * box.yaw);
    marker.scale.x = std::max(0.05F, box.length);
    marker.scale.y = std::max(0.05F, box.width);
    marker.scale.z = std::max(0.05F, box.height);
    marker.color = toColor(info.rgb, 0.35F);
    marker.text = info.name + " " + std::to_string(k + 1) + ": " + std::to_string(object.point_count) + " points";
    array.markers.push_back(marker);

    marker.ns = "texts";
    marker.type = Marker::TEXT_VIEW_FACING;
    marker.pose.position.z = box.z + 0.5 * box.height + 0.4;
    marker.pose.orientation.z = 0.0, marker.pose.orientation.w = 1.0;
    marker.scale.z = 0.4;
    marker.color = toColor(0xFFFFFF, 0.9F);
    array.markers.push_back(marker);
  }
  return array;
}
}  // namespace lidar_panoptic_clustering
