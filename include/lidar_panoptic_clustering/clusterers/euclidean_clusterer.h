#pragma once

#include "lidar_panoptic_clustering/clusterers/link_groups.h"
#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <pcl/point_types.h>

namespace lidar_panoptic_clustering
{
/// The parameters of EuclideanClusterer.
struct EuclideanConfig
{
  double distance_m = 0.0;  ///< points closer than this, and than the link distance, are one object; 0: the latter only
  double voxel_m = 0.1;     ///< edge of the voxels each of which one point stands for

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("distance_m", self.distance_m, 0.0, 10.0);
    visitor("voxel_m", self.voxel_m, 0.01, 1.0);
  }
};

/// Euclidean clustering (Rusu, "Semantic 3D Object Maps for Everyday Manipulation in Human Living Environments", 2010,
/// section 6.2) by pcl::EuclideanClusterExtraction; setting of Zhao et al. 2021.
///
/// The lexicographically smallest point of each voxel and link key stands for it (cell = floor(x / voxel_m)); objects
/// are the components of "closer than distance_m" (at most the link distance, of a key's classes the narrowest) among
/// these; a point belongs to its representative's object.
///
/// n log n in the occupied voxels at usual densities; allocates as PCL does.
class EuclideanClusterer : public Clusterer
{
public:
  /// For the factory.
  using Config = EuclideanConfig;

  /// Throws std::invalid_argument on a value outside its range.
  explicit EuclideanClusterer(const EuclideanConfig& config = {});

  void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) override;

private:
  double tolerance(const ThingScan& scan, std::size_t group) const;
  pcl::PointCloud<pcl::PointXYZ>::Ptr representatives(const ThingScan& scan, std::size_t group);

  EuclideanConfig config_;
  LinkGroups groups_;
  VoxelIndex voxels_;
  std::vector<std::uint32_t> voxel_of_thing_;
  std::vector<std::uint32_t> component_of_voxel_;
};
}  // namespace lidar_panoptic_clustering
