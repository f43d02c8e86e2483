#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The pixels of `projection` with the true label of each one's owner, the true instance where that is a thing, and
/// colours; header left alone. `labels`: one a point of the projected scan, in the data set's packed form. Instance ids
/// are the data set's own, which are unique within a class only. Linear; allocates only while `out` grows.
void paintGroundTruth(const Projection& projection, const std::vector<std::uint32_t>& labels, const ClassTable& table,
                      PanopticCloud& out);
}  // namespace lidar_panoptic_clustering
