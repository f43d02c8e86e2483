#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The object list of each scan of a stream as markers, for RViz and planners.
///
/// An instance is a box (namespace "boxes", in the instance's colour) and a text "CLASS ID" (namespace "texts"), both
/// with the instance id, 1..n, as marker id. After those come deletions of the ids that the list before had and this
/// one has no more.
///
/// RViz keeps each marker by itself until its transform is there, and may take them in another order then: a marker
/// that deletes all would wipe what has just been added. So what is left of an older list is deleted by name, and a
/// lifetime ends what a lost deletion leaves: three intervals between lists, at least three seconds.
class InstanceMarkers
{
public:
  /// `boxes` and `colors` (0xRRGGBB) by instance id - 1. Sides are at least 5 cm, so that RViz shows them.
  visualization_msgs::MarkerArrayPtr update(const std_msgs::Header& header, const ClassTable& table,
                                            const Instances& instances, const std::vector<InstanceBox>& boxes,
                                            const std::vector<std::uint32_t>& colors, ros::Time now);

private:
  ros::Duration nextLifetime(ros::Time now);

  std::size_t previous_count_ = 0;
  ros::Time previous_time_;
};
}  // namespace lidar_panoptic_clustering
