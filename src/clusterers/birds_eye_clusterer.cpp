#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <limits>

namespace lidar_panoptic_clustering
{
BirdsEyeClusterer::BirdsEyeClusterer(const BirdsEyeConfig& config) : config_(config)
{
  validateParameters(config);
  requireOffOrDistance("distance_m", config.distance_m, 10.0);
}

/// Of a key's classes that occur the narrowest.
float BirdsEyeClusterer::distanceOf(const ThingScan& scan, std::size_t group) const
{
  float distance =
      config_.distance_m > 0.0 ? static_cast<float>(config_.distance_m) : std::numeric_limits<float>::infinity();
  for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
    distance = std::min(distance, scan.class_link_distance[scan.class_index[*i]]);
  return distance;
}

void BirdsEyeClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  groups_.build(scan);
  component.resize(scan.size());
  looked_at_ = 0;
  for (std::size_t group = 0; group < groups_.count(); ++group)
  {
    if (groups_.size(group) == 0) continue;
    const float distance = distanceOf(scan, group);
    cells_.clear(distance);
    for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
      cells_.add(scan.points[*i].x, scan.points[*i].y, *i);
    cells_.close();
    cells_.link(distance);
    const auto& component_of_cell = cells_.components();
    for (std::size_t k = 0; k < groups_.size(group); ++k)
      component[groups_.begin(group)[k]] = cells_.firstThing(component_of_cell[cells_.cellOf(k)]);
    looked_at_ += cells_.pointsLookedAt();
  }
}
}  // namespace lidar_panoptic_clustering
