#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kAbsent = 0xFFFFFFFF;
}  // namespace

BirdsEyeClusterer::BirdsEyeClusterer(const BirdsEyeConfig& config) : config_(config)
{
  validateParameters(config);
  requireOffOrDistance("distance_m", config.distance_m, 10.0);
}

void BirdsEyeClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  const float limit =
      config_.distance_m > 0.0 ? static_cast<float>(config_.distance_m) : std::numeric_limits<float>::infinity();
  link_of_class_.assign(scan.class_count, kAbsent);
  for (std::uint32_t i = 0; i < scan.size(); ++i) link_of_class_[scan.class_index[i]] = scan.link[i];
  distance_of_link_.assign(scan.link_count, limit);
  for (std::size_t c = 0; c < link_of_class_.size(); ++c)
    if (link_of_class_[c] != kAbsent)
      distance_of_link_[link_of_class_[c]] =
          std::min(distance_of_link_[link_of_class_[c]], scan.class_link_distance[c]);

  cells_.clear(scan.size());
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    cells_.add(scan.points[i].x, scan.points[i].y, scan.link[i], distance_of_link_[scan.link[i]], i);
  cells_.close();

  cells_.findComponents(distance_of_link_, component_of_cell_);
  component.resize(scan.size());
  for (std::uint32_t i = 0; i < scan.size(); ++i) component[i] = component_of_cell_[cells_.cellOf(i)];
}
}  // namespace lidar_panoptic_clustering
