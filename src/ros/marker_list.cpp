#include "ros/marker_list.h"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

constexpr double kLeastLifetimeS = 3.0, kFirstLifetimeS = 10.0;
constexpr double kTextHeightM = 0.7;
constexpr double kLeastSideM = 0.05;
}  // namespace

std_msgs::ColorRGBA toColor(std::uint32_t rgb, float alpha)
{
  const auto channel = [rgb](int shift) { return static_cast<float>(rgb >> shift & 0xFF) / 255.0F; };
  std_msgs::ColorRGBA color;
  color.r = channel(16), color.g = channel(8), color.b = channel(0), color.a = alpha;
  return color;
}

Marker boxMarker(const Object& object, std::uint32_t rgb)
{
  Marker marker;
  marker.ns = "boxes";
  marker.type = Marker::CUBE;
  marker.pose = object.pose;
  marker.scale.x = std::max(kLeastSideM, object.size.x);
  marker.scale.y = std::max(kLeastSideM, object.size.y);
  marker.scale.z = std::max(kLeastSideM, object.size.z);
  marker.color = toColor(rgb, 0.45F);
  return marker;
}

// RViz warns of a text with a size other than its height, and of a box with a text
Marker textMarker(const Object& object, const std::string& text)
{
  Marker marker;
  marker.ns = "texts";
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.pose.position = object.pose.position;
  marker.pose.position.z += 0.5 * object.size.z + 0.5 * kTextHeightM + 0.1;
  marker.pose.orientation.w = 1.0;
  marker.scale.z = kTextHeightM;
  marker.color = toColor(0xFFFFFF, 1.0F);
  marker.text = text;
  return marker;
}

void MarkerList::begin(const std_msgs::Header& header, ros::Time now)
{
  header_ = header;
  lifetime_ = nextLifetime(now);
  array_ = boost::make_shared<visualization_msgs::MarkerArray>();
  std::swap(shown_, previous_);
  shown_.clear();
}

void MarkerList::add(Marker&& marker, std::uint32_t id)
{
  marker.header = header_;
  marker.id = static_cast<std::int32_t>(id);
  marker.lifetime = lifetime_;
  if (marker.action == Marker::ADD) shown_.push_back({marker.ns, marker.id});
  array_->markers.push_back(std::move(marker));
}

visualization_msgs::MarkerArrayPtr MarkerList::finish()
{
  std::sort(shown_.begin(), shown_.end());
  gone_.clear();
  std::set_difference(previous_.begin(), previous_.end(), shown_.begin(), shown_.end(), std::back_inserter(gone_));
  for (const Name& name : gone_)
  {
    Marker marker;
    marker.ns = name.space;
    marker.action = Marker::DELETE;
    marker.pose.orientation.w = 1.0;
    add(std::move(marker), static_cast<std::uint32_t>(name.id));
  }
  return std::move(array_);
}

ros::Duration MarkerList::nextLifetime(ros::Time now)
{
  const double interval_s = previous_time_.isZero() ? -1.0 : (now - previous_time_).toSec();
  previous_time_ = now;
  // the first list, and the first after a clock was set back
  if (interval_s < 0.0) return ros::Duration(kFirstLifetimeS);
  return ros::Duration(std::clamp(3.0 * interval_s, kLeastLifetimeS, 600.0));
}
}  // namespace lidar_panoptic_clustering
