#include "ros/instance_markers.h"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

constexpr const char* kBoxes = "boxes";
constexpr const char* kTexts = "texts";
constexpr double kLeastLifetimeS = 3.0, kFirstLifetimeS = 10.0;
constexpr double kTextHeightM = 0.7;

std_msgs::ColorRGBA toColor(std::uint32_t rgb, float alpha)
{
  const auto channel = [rgb](int shift) { return static_cast<float>(rgb >> shift & 0xFF) / 255.0F; };
  std_msgs::ColorRGBA color;
  color.r = channel(16), color.g = channel(8), color.b = channel(0), color.a = alpha;
  return color;
}

Marker boxMarker(const InstanceBox& box, std::uint32_t rgb)
{
  Marker marker;
  marker.ns = kBoxes;
  marker.type = Marker::CUBE;
  marker.pose.position.x = box.x, marker.pose.position.y = box.y, marker.pose.position.z = box.z;
  marker.pose.orientation.z = std::sin(0.5 * box.yaw), marker.pose.orientation.w = std::cos(0.5 * box.yaw);
  marker.scale.x = std::max(0.05F, box.length);
  marker.scale.y = std::max(0.05F, box.width);
  marker.scale.z = std::max(0.05F, box.height);
  marker.color = toColor(rgb, 0.45F);
  return marker;
}

/// Above its box. RViz warns of a text with a size other than its height, and of a box with a text.
Marker textMarker(const InstanceBox& box, const std::string& text)
{
  Marker marker;
  marker.ns = kTexts;
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.pose.position.x = box.x, marker.pose.position.y = box.y;
  marker.pose.position.z = box.z + 0.5 * box.height + 0.5 * kTextHeightM + 0.1;
  marker.pose.orientation.w = 1.0;
  marker.scale.z = kTextHeightM;
  marker.color = toColor(0xFFFFFF, 1.0F);
  marker.text = text;
  return marker;
}
}  // namespace

visualization_msgs::MarkerArrayPtr InstanceMarkers::update(const std_msgs::Header& header, const ClassTable& table,
                                                           const Instances& instances,
                                                           const std::vector<InstanceBox>& boxes,
                                                           const std::vector<std::uint32_t>& colors, ros::Time now)
{
  const auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  const ros::Duration lifetime = nextLifetime(now);
  const auto add = [&](Marker marker, std::size_t id, int action)
  {
    marker.header = header;
    marker.id = static_cast<int>(id);
    marker.action = action;
    marker.lifetime = lifetime;
    array->markers.push_back(std::move(marker));
  };

  const std::size_t count = instances.count();
  array->markers.reserve(2 * std::max(count, previous_count_));
  for (std::size_t k = 0; k < count; ++k)
  {
    add(boxMarker(boxes[k], colors[k]), k + 1, Marker::ADD);
    add(textMarker(boxes[k], table[instances.objects[k].class_index].name + " " + std::to_string(k + 1)), k + 1,
        Marker::ADD);
  }
  for (std::size_t id = count + 1; id <= previous_count_; ++id)
    for (const char* name : {kBoxes, kTexts})
    {
      Marker marker;
      marker.ns = name;
      marker.pose.orientation.w = 1.0;
      add(std::move(marker), id, Marker::DELETE);
    }
  previous_count_ = count;
  return array;
}

ros::Duration InstanceMarkers::nextLifetime(ros::Time now)
{
  const double interval_s = previous_time_.isZero() ? -1.0 : (now - previous_time_).toSec();
  previous_time_ = now;
  // the first list, and the first after a clock was set back
  if (interval_s < 0.0) return ros::Duration(kFirstLifetimeS);
  return ros::Duration(std::clamp(3.0 * interval_s, kLeastLifetimeS, 600.0));
}
}  // namespace lidar_panoptic_clustering
