#pragma once

#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Points in square cells of bird's-eye view whose diagonal is a distance of interest: those of a cell are closer than
/// it without a comparison, and only the 24 cells around (kReach either side) can hold others that are.
///
/// A cell also has a layer, so that points of several kinds can lie in one place apart. Keeps its memory.
///
/// Holds for coordinates of up to 10 km and distances of 0.2 mm and more: less than 2^27 cells.
class PlanarCells
{
public:
  /// Begins anew, with room for `capacity` points.
  void clear(std::size_t capacity);
  /// To be called for each point, then close(). `distance` is the diagonal of the layer's cells [m]; layers
  /// are 0 to 255.
  void add(float x, float y, std::int32_t layer, float distance, std::uint32_t thing);
  void close();

  std::uint32_t size() const { return static_cast<std::uint32_t>(ranges_.size()); }

  /// The things of a cell, in no order that means anything.
  template <class Visit>
  void forEach(std::uint32_t cell, const Visit& visit) const
  {
    for (std::uint32_t k = ranges_[cell].begin; k < ranges_[cell].end; ++k) visit(points_[k].thing);
  }
  std::uint32_t firstThing(std::uint32_t cell) const { return points_[ranges_[cell].begin].thing; }
  /// The cell of the point that was the k-th to be added.
  std::uint32_t cellOf(std::size_t k) const { return cell_of_added_[k]; }

  /// The components of "closer than the layer's distance" within each layer, by cell: each cell's value is the first
  /// cell of its component. `distance_of_layer`: what add() was given. n log n in the cells; two cells are compared in
  /// time linear in their points, n log n for those of a cell at its first difficult comparison.
  void findComponents(const std::vector<float>& distance_of_layer, std::vector<std::uint32_t>& component_of_cell);

  /// Points looked at by these comparisons since clear(), for tests that bound the work.
  std::size_t pointsLookedAt() const { return looked_at_; }

private:
  static constexpr int kReach = 2;
  static constexpr std::uint32_t kNone = PlanarIndex::kNone;

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
  /// A disc's upper edge, above those of all other discs from `from` to the next arc's.
  struct Arc
  {
    double u, v;  ///< the disc's centre, v the height
    double from;
  };

  /// A cell, and where it comes in the order of rows.
  struct Place
  {
    std::uint64_t place;
    std::uint32_t cell;
  };

  void joinNeighbours(const std::vector<float>& distance_of_layer, int reach);
  bool areCloser(std::uint32_t cell_a, std::uint32_t cell_b, float distance);
  bool isAnyPairCloser(Range a, Range b, float squared_distance);
  bool isGreedyPairCloser(Range a, Range b, const Box& box_b, float squared_distance);
  bool reachesOver(std::uint32_t low, std::uint32_t high, bool along_y, float distance);
  void drawEnvelope(std::uint32_t cell, bool along_y, double distance);
  const Point& nearest(Range range, float x, float y);
  const Box& boxOf(std::uint32_t cell);
  const Point* sorted(std::uint32_t cell, bool along_y);

  PlanarIndex index_;
  std::vector<Range> ranges_;  ///< by cell
  std::vector<Point> added_, points_;
  std::vector<std::uint32_t> cell_of_added_;
  float last_distance_ = 0.0F, cells_per_m_ = 0.0F;  ///< of the point added last, like the next two
  PlanarKey last_key_{};
  std::uint32_t last_cell_ = kNone;

  std::vector<Box> boxes_;                              ///< by cell; min above max until it is asked for
  std::array<std::vector<std::uint8_t>, 2> is_sorted_;  ///< by cell: whether it is in sorted_
  std::array<std::vector<Point>, 2> sorted_;            ///< points_, each cell's along x and along y
  std::vector<Arc> envelope_;
  std::vector<Place> places_;
  DisjointSets sets_;
  std::size_t looked_at_ = 0;
};
}  // namespace lidar_panoptic_clustering
