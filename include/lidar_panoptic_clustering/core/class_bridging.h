#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/disjoint_sets.h"
#include "lidar_panoptic_clustering/core/part_merging.h"
#include "lidar_panoptic_clustering/core/planar_cells.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Joins objects of one group of classes that touch: a network that paints half a car as a truck makes two objects of
/// it, and so do rules that look along scan lines and columns only.
///
/// Two objects are one when two points of theirs are closer than `distance` in bird's-eye view. Linear in the points at
/// usual densities; keeps its memory.
class ClassBridging
{
public:
  /// Writes for each object which one it belongs to, the first in order for each whole. `object_of_thing` runs parallel
  /// to the scan's points. A `distance` of 0 joins nothing.
  void join(const ThingScan& scan, const ClassTable& table, float distance, const std::vector<RefinedObject>& objects,
            const std::vector<std::uint32_t>& object_of_thing, std::vector<std::uint32_t>& whole_of);

private:
  void stackCells(const std::vector<RefinedObject>& objects, const ClassTable& table);

  PlanarCells cells_;                 ///< a layer an object
  VoxelIndex stacks_;                 ///< places of cells, a layer a group
  std::vector<std::uint32_t> top_;    ///< by stack: its first cell
  std::vector<std::uint32_t> below_;  ///< by cell: the next of its stack
  DisjointSets sets_;
};
}  // namespace lidar_panoptic_clustering
