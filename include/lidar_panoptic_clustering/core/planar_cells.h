#pragma once

#include "lidar_panoptic_clustering/core/disjoint_sets.h"
#include "lidar_panoptic_clustering/core/voxel_index.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Points in square cells of bird's-eye view whose diagonal is a distance of interest: those of a cell are closer than
/// it without a comparison, and only the 24 cells around (kReach either side) can hold others that are.
///
/// A cell also has a layer, so that points of several kinds can lie in one place apart. Keeps its memory.
class PlanarCells
{
public:
  static constexpr int kReach = 2;
  static constexpr std::uint32_t kNone = VoxelIndex::kNone;

  /// Begins anew, with room for `capacity` points.
  void clear(std::size_t capacity);
  /// To be called for each point, then close(). `distance` is the diagonal of the layer's cells [m], above 0.
  void add(float x, float y, std::int32_t layer, float distance, std::uint32_t thing);
  void close();

  std::uint32_t size() const { return static_cast<std::uint32_t>(ranges_.size()); }
  const VoxelKey& key(std::uint32_t cell) const { return index_[cell]; }
  std::uint32_t find(const VoxelKey& key) const { return index_.find(key); }

  /// The things of a cell, in no order that means anything.
  template <class Visit>
  void forEach(std::uint32_t cell, const Visit& visit) const
  {
    for (std::uint32_t k = ranges_[cell].begin; k < ranges_[cell].end; ++k) visit(points_[k].thing);
  }
  std::uint32_t firstThing(std::uint32_t cell) const { return points_[ranges_[cell].begin].thing; }

  /// Whether a point of one cell is closer than `distance` to one of the other. Halves both, box against box: about
  /// linear in their points where the cells are clearly near or far, at the worst (dense walls at just that distance)
  /// their number to the power 1.5.
  bool areCloser(std::uint32_t cell_a, std::uint32_t cell_b, float distance);

  /// The components of "closer than the layer's distance" within each layer, by cell: each cell's value is the first
  /// cell of its component. `distance_of_layer`: what add() was given.
  void findComponents(const std::vector<float>& distance_of_layer, std::vector<std::uint32_t>& component_of_cell);

  /// Points looked at by areCloser() since clear(), for tests that bound the work.
  std::size_t pointsLookedAt() const { return looked_at_; }

private:
  struct Point
  {
    float x, y;
    std::uint32_t thing;
  };
  struct Range
  {
    std::uint32_t begin, end;  ///< of points_
  };
  struct Box
  {
    float min_x, max_x, min_y, max_y;
  };

  bool anyCloser(Range a, Range b, float squared_distance);
  Box boxOf(Range range) const;
  Range halve(Range& range, const Box& box);

  VoxelIndex index_;
  std::vector<Range> ranges_;  ///< by cell
  std::vector<Point> added_, points_;
  std::vector<std::uint32_t> cell_of_added_;
  DisjointSets sets_;
  std::size_t looked_at_ = 0;
};
}  // namespace lidar_panoptic_clustering
