#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"
#include "lidar_panoptic_clustering/geometry/step_sort.h"
#include "lidar_panoptic_clustering/refinement/part_merging.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Joins objects of one group of classes that touch: a network that paints half a car as a truck makes two objects of
/// it, and so do rules that look along scan lines and columns only.
///
/// Two objects are one when two points of theirs are closer than `distance` in bird's-eye view. Outlines tell which
/// objects can be that close, and only their points where the other's outline is near are compared: n log n in the
/// objects and in the cells of those points. Keeps its memory.
class ClassBridging
{
public:
  /// Writes for each object which one it belongs to, the first in order for each whole. `object_of_thing` runs parallel
  /// to the scan's points. A `distance` of 0 joins nothing.
  void join(const ThingScan& scan, const ClassTable& table, float distance, const std::vector<RefinedObject>& objects,
            const std::vector<std::uint32_t>& object_of_thing, std::vector<std::uint32_t>& whole_of);

private:
  /// Where an object's points can be near another one's: an upright rectangle, empty where there is none.
  struct Reach
  {
    float min_x, max_x, min_y, max_y;
    void add(const Footprint& other, float distance);
    bool contains(float x, float y) const { return x >= min_x && x <= max_x && y >= min_y && y <= max_y; }
  };

  static const Reach kEverywhere;

  struct Start
  {
    float min_x;
    std::uint32_t object;
  };
  /// What tells most pairs of objects apart, without a look at these.
  struct Extent
  {
    float max_x, min_y, max_y;
    std::uint32_t group;
    bool mayBeCloser(const Extent& other, float distance) const
    {
      return group == other.group && min_y - other.max_y < distance && other.min_y - max_y < distance;
    }
  };

  bool lookAtAll(const ThingScan& scan, const std::vector<RefinedObject>& objects);
  bool findReaches(const std::vector<RefinedObject>& objects, const ClassTable& table, float distance);
  void sortByGroup(const ThingScan& scan, const ClassTable& table, const std::vector<RefinedObject>& objects,
                   const std::vector<std::uint32_t>& object_of_thing);
  void uniteClose(const ThingScan& scan, const std::vector<std::uint32_t>& things, float distance,
                  const std::vector<std::uint32_t>& object_of_thing);

  std::vector<Start> by_min_x_;  ///< objects
  FloatSort<Start> start_sort_;
  std::vector<Extent> extents_;                              ///< parallel to by_min_x_
  std::vector<Reach> reach_;                                 ///< by object
  std::vector<std::uint32_t> group_of_;                      ///< by object
  std::vector<std::vector<std::uint32_t>> things_of_group_;  ///< within reach of another object
  PlanarHierarchy cells_;                                    ///< of a group's
  DisjointSets sets_;
};
}  // namespace lidar_panoptic_clustering
