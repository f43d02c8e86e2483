#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/instances.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include <lidar_panoptic_clustering/ObjectArray.h>

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// To one of so many steps in a unit, a tenth of a millimetre, so that a printed message can be read.
double rounded(double value, double steps = 1e4);

/// What a message says of a class: its name and canonical id.
void setClass(const ClassTable& table, ClassIndex class_index, Object& object);
/// Pose and size of a box.
void setBox(const InstanceBox& box, Object& object);

/// The objects of one scan by itself: no track ids, no velocities. `boxes` by instance id - 1. Linear.
ObjectArrayPtr listObjects(const std_msgs::Header& header, const ClassTable& table, const ThingScan& things,
                           const Instances& instances, const std::vector<InstanceBox>& boxes);
}  // namespace lidar_panoptic_clustering
