#pragma once

#include <lidar_panoptic_clustering/core/clusterer.h>
#include <lidar_panoptic_clustering/geometry/disjoint_sets.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace grid_clustering_example
{
/// Two thing points belong together when they are linkable and lie in squares of the ground that are the same or touch,
/// by a side or a corner. The rule looks at no rows and columns, so that the wrap of a full turn does not concern it.
/// Linear in the points.
class GridClusterer : public lidar_panoptic_clustering::Clusterer
{
public:
  /// `cell_m`: side of a square [m], above 0. Points further apart than 2 sqrt(2) sides never touch.
  explicit GridClusterer(double cell_m) : cell_m_(cell_m) {}

  void cluster(const lidar_panoptic_clustering::ThingScan& scan, std::vector<std::uint32_t>& component) override;

private:
  double cell_m_;
  lidar_panoptic_clustering::DisjointSets sets_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_in_;  ///< by link and square: the first point there
};
}  // namespace grid_clustering_example
