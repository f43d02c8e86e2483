#pragma once

#include "ros/marker_list.h"

#include <lidar_panoptic_clustering/ObjectArray.h>

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The object list of each scan of a stream as markers, for RViz.
///
/// An instance is a box (namespace "boxes", in the instance's colour) and a text "CLASS ID" (namespace "texts"), both
/// with the instance id, 1..n, as marker id; see MarkerList for those that are no more.
class InstanceMarkers
{
public:
  /// `colors` (0xRRGGBB) by instance id - 1.
  visualization_msgs::MarkerArrayPtr update(const ObjectArray& list, const std::vector<std::uint32_t>& colors,
                                            ros::Time now);

private:
  MarkerList markers_;
};
}  // namespace lidar_panoptic_clustering
