#pragma once

#include "lidar_panoptic_clustering/clusterers/link_groups.h"
#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"

namespace lidar_panoptic_clustering
{
/// The parameters of BirdsEyeClusterer.
struct BirdsEyeConfig
{
  double distance_m = 0.0;  ///< points closer than this, and than the link distance, are one object; 0: the latter only

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("distance_m", self.distance_m, 0.0, 10.0);
  }
};

/// Components of the graph "closer than distance_m (at most the link distance, of a link key's classes the narrowest)
/// in bird's-eye view" among linkable points, exact. Height plays no part, so that windows, bumpers and beams far apart
/// do not part an object; class-wise graphs in bird's-eye view are ALPINE's idea (Sautier et al. 2025).
///
/// Works on a grid (see PlanarHierarchy): linear in the points, n log n where cells are hard to tell apart. Rows and
/// columns are not looked at: the cloud need not be organised.
class BirdsEyeClusterer : public Clusterer
{
public:
  /// For the factory.
  using Config = BirdsEyeConfig;

  /// Throws std::invalid_argument on a value outside its range.
  explicit BirdsEyeClusterer(const BirdsEyeConfig& config = {});

  void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) override;

  /// Points compared in the last scan, for tests that bound the work.
  std::size_t pointsLookedAt() const { return looked_at_; }

private:
  float distanceOf(const ThingScan& scan, std::size_t group) const;

  BirdsEyeConfig config_;
  LinkGroups groups_;
  PlanarHierarchy cells_;  ///< of the link key in hand
  std::size_t looked_at_ = 0;
};
}  // namespace lidar_panoptic_clustering
