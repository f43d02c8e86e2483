#pragma once

#include "lidar_panoptic_clustering/clusterers/link_groups.h"
#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

namespace lidar_panoptic_clustering
{
struct SupervoxelConfig
{
  double voxel_m = 0.5;         ///< edge of a voxel
  double seed_m = 8.0;          ///< distance of the seeds supervoxels grow from
  double color_weight = 0.0;    ///< clouds carry no colour; kept for the rule's completeness
  double spatial_weight = 1.0;  ///< weight of the distance to a supervoxel's centre
  double normal_weight = 0.0;   ///< weight of the angle between normals

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("voxel_m", self.voxel_m, 0.05, 2.0);
    visitor("seed_m", self.seed_m, 0.1, 50.0);
    visitor("color_weight", self.color_weight, 0.0, 1.0);
    visitor("spatial_weight", self.spatial_weight, 0.0, 1.0);
    visitor("normal_weight", self.normal_weight, 0.0, 1.0);
  }
};

/// Supervoxels (Papon et al., "Voxel Cloud Connectivity Segmentation - Supervoxels for Point Clouds", CVPR 2013) by
/// pcl::SupervoxelClustering, once for each link key; settings of Zhao et al. 2021.
///
/// A point belongs to the supervoxel of its own voxel. PCL drops seeds with few voxels about them and with them small
/// objects: voxels without a supervoxel form objects by 26-adjacency. A seed distance below the voxel's edge is
/// raised to it.
///
/// Time and memory are PCL's: n log n in the points, allocates.
class SupervoxelClusterer : public Clusterer
{
public:
  using Config = SupervoxelConfig;

  /// Throws std::invalid_argument on a value outside its range.
  explicit SupervoxelClusterer(const SupervoxelConfig& config = {});

  void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) override;

private:
  struct Thing
  {
    float x, y, z;
    std::uint32_t index;  ///< in the ThingScan
  };

  std::uint32_t clusterGroup(const ThingScan& scan, std::size_t group, std::uint32_t first_object,
                             std::vector<std::uint32_t>& component);
  std::uint32_t joinLeftOver(std::uint32_t next_object);
  void numberUsed(std::uint32_t objects, std::vector<std::uint32_t>& component);

  SupervoxelConfig config_;
  LinkGroups groups_;
  VoxelIndex voxels_;
  std::vector<Thing> things_;                  ///< of the group in hand, in order of (x, y, z)
  std::vector<std::uint32_t> voxel_of_point_;  ///< parallel to things_
  std::vector<std::uint32_t> object_of_voxel_;
  std::vector<std::uint32_t> object_of_set_;
  std::vector<std::uint32_t> number_of_object_;
  DisjointSets left_over_;
};
}  // namespace lidar_panoptic_clustering
