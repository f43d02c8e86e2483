#include "ros/track_markers.h"

#include "core/plain_numbers.h"
#include "lidar_panoptic_clustering/core/color_series.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

constexpr double kMovesMps = 0.5;  // slower ones are shown without arrow and speed
constexpr double kStepM = 0.25;    // between the points of a way
constexpr double kArrowM = 0.15;   // its shaft

double speedOf(const Object& object)
{
  return std::hypot(object.velocity.x, object.velocity.y);
}

std::string textOf(const Object& object)
{
  const std::string name = object.class_name + " #" + std::to_string(object.track_id);
  return speedOf(object) < kMovesMps ? name : name + " " + fixedText(speedOf(object), 1) + " m/s";
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& p)
{
  geometry_msgs::Point point;
  point.x = p.x(), point.y = p.y(), point.z = p.z();
  return point;
}

Marker arrowMarker(const Object& object, std::uint32_t rgb)
{
  Marker marker;
  marker.ns = "velocities";
  marker.type = Marker::ARROW;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = kArrowM, marker.scale.y = 3.0 * kArrowM, marker.scale.z = 4.0 * kArrowM;
  marker.color = toColor(rgb, 1.0F);
  geometry_msgs::Point from = object.pose.position, to = from;
  to.x += object.velocity.x, to.y += object.velocity.y, to.z += object.velocity.z;
  marker.points = {from, to};
  return marker;
}
}  // namespace

visualization_msgs::MarkerArrayPtr TrackMarkers::update(const ObjectArray& list, const std::vector<ListedTrack>& tracks,
                                                        const Eigen::Isometry3d& fixed_from_sensor, ros::Time now)
{
  const Eigen::Isometry3d sensor_from_fixed = fixed_from_sensor.inverse();
  forgetAllBut(tracks);
  markers_.begin(list.header, now);
  for (std::size_t i = 0; i < tracks.size(); ++i)
  {
    const Object& object = list.objects[i];
    if (object.points == 0) continue;  // hidden: its way is kept, nothing is shown
    const std::uint32_t id = object.track_id, rgb = seriesColor(id);
    Trail& trail = trailOf(id);
    extend(trail, tracks[i], fixed_from_sensor);
    markers_.add(boxMarker(object, rgb), id);
    markers_.add(textMarker(object, textOf(object)), id);
    if (speedOf(object) >= kMovesMps) markers_.add(arrowMarker(object, rgb), id);
    if (trail.count > 1) markers_.add(trailMarker(trail, rgb, sensor_from_fixed), id);
  }
  return markers_.finish();
}

TrackMarkers::Trail& TrackMarkers::trailOf(std::uint32_t track)
{
  const auto at = std::lower_bound(trails_.begin(), trails_.end(), track,
                                   [](const Trail& trail, std::uint32_t id) { return trail.track < id; });
  if (at != trails_.end() && at->track == track) return *at;
  Trail trail;
  trail.track = track;
  return *trails_.insert(at, trail);
}

void TrackMarkers::extend(Trail& trail, const ListedTrack& listed, const Eigen::Isometry3d& fixed_from_sensor)
{
  const Eigen::Vector3d low(listed.box.x, listed.box.y, listed.box.z - 0.5F * listed.box.height);
  // what the filter holds moves evenly; the box's middle jumps as more of the object is seen
  const Place here{listed.object.position.x(), listed.object.position.y(), (fixed_from_sensor * low).z()};
  const Place& last = trail.way[(trail.count + kKept - 1) % kKept];
  if (trail.count > 0 && std::hypot(here.x - last.x, here.y - last.y) < kStepM) return;
  trail.way[trail.count++ % kKept] = here;
}

Marker TrackMarkers::trailMarker(const Trail& trail, std::uint32_t rgb, const Eigen::Isometry3d& sensor_from_fixed)
{
  Marker marker;
  marker.ns = "trails";
  marker.type = Marker::LINE_STRIP;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.12;
  marker.color = toColor(rgb, 0.99F);  // RViz looks at the points' alpha only where this is below 1
  const std::uint32_t kept = std::min<std::uint32_t>(trail.count, kKept);
  for (std::uint32_t k = 0; k < kept; ++k)
  {
    const Place& place = trail.way[(trail.count - kept + k) % kKept];
    marker.points.push_back(toPoint(sensor_from_fixed * Eigen::Vector3d(place.x, place.y, place.z)));
    marker.colors.push_back(toColor(rgb, static_cast<float>(k + 1) / static_cast<float>(kept)));
  }
  return marker;
}

void TrackMarkers::forgetAllBut(const std::vector<ListedTrack>& tracks)
{
  listed_.clear();
  for (const ListedTrack& listed : tracks) listed_.push_back(listed.object.track);
  std::sort(listed_.begin(), listed_.end());
  const auto is_gone = [this](const Trail& trail)
  { return !std::binary_search(listed_.begin(), listed_.end(), trail.track); };
  trails_.erase(std::remove_if(trails_.begin(), trails_.end(), is_gone), trails_.end());
}
}  // namespace lidar_panoptic_clustering
