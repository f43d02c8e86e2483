#include "ros/instance_markers.h"

#include <string>

namespace lidar_panoptic_clustering
{
visualization_msgs::MarkerArrayPtr InstanceMarkers::update(const ObjectArray& list,
                                                           const std::vector<std::uint32_t>& colors, ros::Time now)
{
  markers_.begin(list.header, now);
  for (const Object& object : list.objects)
  {
    markers_.add(boxMarker(object, colors[object.instance_id - 1]), object.instance_id);
    markers_.add(textMarker(object, object.class_name + " " + std::to_string(object.instance_id)), object.instance_id);
  }
  return markers_.finish();
}
}  // namespace lidar_panoptic_clustering
