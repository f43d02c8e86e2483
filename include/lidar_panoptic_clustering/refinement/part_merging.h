#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"
#include "lidar_panoptic_clustering/geometry/step_sort.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An object as refinement sees it.
struct RefinedObject
{
  ClassIndex class_index = kUnknownClass;          ///< of most of its points
  std::uint32_t point_count = 0;                   ///< its thing points
  float sum_x = 0.0F, sum_y = 0.0F, sum_z = 0.0F;  ///< of its points [m]
  Footprint footprint;                             ///< in bird's-eye view

  /// Adds another object's points, but not its outline.
  void addPoints(const RefinedObject& other)
  {
    point_count += other.point_count;
    sum_x += other.sum_x, sum_y += other.sum_y, sum_z += other.sum_z;
  }
  /// Adds another object's points and outline.
  void add(const RefinedObject& other)
  {
    addPoints(other);
    footprint.add(other.footprint);
  }
};

/// Joins parts of one object that occlusion or a class border has parted.
///
/// Two objects of a class are one when a rectangle of the class's usual size holds both, the gap between their outlines
/// in bird's-eye view is below twice the class's link distance, and no third object lies between them (on the shortest
/// line from one to the other); where the gap is below the link distance, the rectangle may be 1.3 times as large. The
/// nearest pairs join first; what has joined is measured as a whole.
///
/// n log n in the objects: each is compared with at most 64 others in its neighbourhood (with 4 in a scan of 65,536).
/// The result does not depend on the objects' order. Keeps its memory.
class PartMerger
{
public:
  /// Writes for each object which one it belongs to: one of the whole's own, the same for all of them.
  void merge(const std::vector<RefinedObject>& objects, const ClassTable& table, std::vector<std::uint32_t>& whole_of);

private:
  struct Pair
  {
    float squared_gap;
    std::uint32_t a, b;
  };
  struct Start
  {
    float min_x, min_y;
    std::uint32_t object;
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  void sortObjects(const std::vector<RefinedObject>& objects);
  void fillGrid();
  void collectPairs(const ClassTable& table);
  void compareWithEarlier(std::uint32_t a, const ClassInfo& info);
  bool isParted(std::uint32_t a, std::uint32_t b, const Footprint::Gap& gap) const;
  template <class Visit>
  void visitCells(float min_x, float max_x, float min_y, float max_y, const Visit& visit) const;

  std::vector<Start> by_min_x_;
  FloatSort<Start> start_sort_;
  std::vector<std::uint32_t> order_;  ///< objects by place: by where they begin along x
  std::vector<Footprint> outlines_;   ///< by place; a whole's first has its outline
  std::vector<ClassIndex> class_of_;  ///< by place

  VoxelIndex grid_;
  std::vector<std::uint32_t> cell_of_entry_, first_entry_;  ///< cells by object, and where an object's begin
  std::vector<std::uint32_t> begin_, filled_;  ///< by cell, into entries_: its first, the next to be filled
  std::vector<std::uint32_t> entries_;         ///< objects, cell by cell, in rising order
  std::vector<std::uint32_t> seen_;            ///< by object: the last one it was compared with
  std::vector<Pair> pairs_;
  FloatSort<Pair> pair_sort_;
  DisjointSets sets_;
};
}  // namespace lidar_panoptic_clustering
