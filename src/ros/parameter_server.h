#pragma once

#include "lidar_panoptic_clustering/core/parameters.h"

#include <ros/node_handle.h>

#include <vector>

namespace lidar_panoptic_clustering
{
/// The parameters named in `known` that are set in the namespace of `nh`, each of the type of its `value` (an integer
/// is fine where a double is expected); others on the server are ignored. Ranges and choices are left to
/// applyParameters. Throws std::invalid_argument, naming the full parameter name, on any other type.
ParameterMap readParameters(const ros::NodeHandle& nh, const std::vector<ParameterInfo>& known);
}  // namespace lidar_panoptic_clustering
