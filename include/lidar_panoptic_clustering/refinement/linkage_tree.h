#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How one object's points hang together in bird's-eye view at two to nine tenths of a distance: single linkage, all of
/// it from one hierarchy of cells.
///
/// A leaf is what hangs together at two tenths; leaves are numbered by their first point. Components at a wider
/// distance are made of whole leaves. Linear in the points; keeps its memory.
class LinkageTree
{
public:
  static constexpr int kFinest = 2, kCoarsest = 9;  ///< tenths of the distance

  /// Finds the leaves. `things`: the object's `count` points, indices into the scan, in rising order; `reach`: the
  /// whole distance [m].
  void build(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach);

  /// Number of leaves.
  std::uint32_t size() const { return static_cast<std::uint32_t>(size_.size()); }
  /// The leaf of the k-th of the things.
  std::uint32_t leafOf(std::size_t k) const { return leaf_of_point_[k]; }
  /// A leaf's points.
  std::uint32_t pointsOf(std::uint32_t leaf) const { return size_[leaf]; }

  /// By leaf: the first leaf of its component at `tenths`, kFinest..kCoarsest. Links the distances up to there when
  /// they are asked for.
  const std::vector<std::uint32_t>& components(int tenths);

private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  void linkNext();

  PlanarHierarchy cells_;
  float reach_ = 0.0F;
  int linked_ = kFinest;   ///< tenths
  bool is_whole_ = false;  ///< one component is left
  std::vector<std::uint32_t> leaf_of_point_, size_, leaf_of_cell_;
  std::vector<std::uint32_t> cell_of_leaf_;                          ///< one of its cells
  std::array<std::vector<std::uint32_t>, kCoarsest + 1> component_;  ///< by tenths
};
}  // namespace lidar_panoptic_clustering
