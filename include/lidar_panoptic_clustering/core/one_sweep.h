#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

namespace lidar_panoptic_clustering
{
/// Whether the returns of a cloud come as one scan line does: the azimuth goes one way, at most once around, and the
/// elevation changes no faster than it. For clouds of one row, which may be a line or points of any order.
///
/// One step in twenty, and two more, may go astray. Linear; stops where too many have.
bool comesInOneSweep(const LabelledCloud& cloud);
}  // namespace lidar_panoptic_clustering
