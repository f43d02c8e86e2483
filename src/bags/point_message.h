#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <sensor_msgs/PointCloud2.h>

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A scan's points in their own order as a driver publishes them: one row of x y z intensity (float32), ring (uint16, 0
/// the lowest beam, as velodyne_pointcloud numbers them) and, with `labels`, label (uint32, the raw class id). 24 bytes
/// a point. Points without a return stay as the file has them. Fills all but the header.
///
/// `projection`: of the same scan, for the rings. `labels`: one a point in the data set's packed form, or empty.
/// Throws std::invalid_argument where their numbers differ. Linear.
void toPointMessage(const std::vector<ScanPoint>& scan, const Projection& projection,
                    const std::vector<std::uint32_t>& labels, sensor_msgs::PointCloud2& message);
}  // namespace lidar_panoptic_clustering
