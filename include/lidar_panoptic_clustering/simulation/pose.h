#pragma once

#include "lidar_panoptic_clustering/core/language.h"

namespace lidar_panoptic_clustering::simulation
{
/// Where something upright stands in the world: x east, y north, z up [m], yaw from x to y [rad].
struct Pose
{
  double x = 0.0, y = 0.0, z = 0.0, yaw = 0.0;
};
}  // namespace lidar_panoptic_clustering::simulation
