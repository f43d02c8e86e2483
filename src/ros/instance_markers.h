#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

namespace lidar_panoptic_clustering
{
/// The object list of a scan, for RViz and planners: first a marker that deletes the list before, then an instance's
/// box (namespace "boxes", class colour) and its text "CLASS ID: N points" (namespace "texts"), both with the instance
/// id as marker id. The box's marker carries the text too. Sides are at least 5 cm, so that RViz shows them.
visualization_msgs::MarkerArray instanceMarkers(const std_msgs::Header& header, const ClassTable& table,
                                                const Instances& instances, const std::vector<InstanceBox>& boxes);
}  // namespace lidar_panoptic_clustering
