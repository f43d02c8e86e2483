#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <limits>

namespace lidar_panoptic_clustering
{
BirdsEyeClusterer::BirdsEyeClusterer(const BirdsEyeConfig& config) : config_(config)
{
  validateParameters(config);
}

void BirdsEyeClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  const float limit =
      config_.distance_m > 0.0 ? static_cast<float>(config_.distance_m) : std::numeric_limits<float>::infinity();
  distance_of_link_.assign(scan.link_count, limit);
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    distance_of_link_[scan.link[i]] = std::min(distance_of_link_[scan.link[i]], scan.linkDistance(i, i));

  cells_.clear(scan.size());
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    cells_.add(scan.points[i].x, scan.points[i].y, scan.link[i], distance_of_link_[scan.link[i]], i);
  cells_.close();

  cells_.findComponents(distance_of_link_, component_of_cell_);
  component.resize(scan.size());
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
    cells_.forEach(cell, [&](std::uint32_t thing) { component[thing] = component_of_cell_[cell]; });
}
}  // namespace lidar_panoptic_clustering
