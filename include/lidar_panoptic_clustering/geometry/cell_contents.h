#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A point in bird's-eye view, and whose it is.
struct PlanarSample
{
  float x, y;           ///< [m]
  std::uint32_t thing;  ///< the caller's number for it
};

/// Points sorted into square cells of bird's-eye view, and whether two of the cells hold points that are close. What is
/// found about a cell on the way (extent, order along an axis) is kept for its next comparison.
class CellContents
{
public:
  /// The place of a cell on its grid.
  struct Place
  {
    std::int32_t x, y;  ///< cells, from any origin
  };
  /// Cells [begin, end) in order, which lie together in a square.
  struct Block
  {
    std::uint32_t begin, end;  ///< cells
  };

  /// Begins anew with the points of a scan, to be written into points() in order of cells.
  void clear(std::size_t points);
  /// The points, cell by cell.
  std::vector<PlanarSample>& points() { return points_; }
  /// Begins a cell with point `first`.
  void addCell(std::uint32_t first, Place place)
  {
    begin_.push_back(first);
    place_.push_back(place);
  }
  /// To be called after the last cell.
  void close();

  /// Number of cells.
  std::uint32_t size() const { return static_cast<std::uint32_t>(place_.size()); }
  /// The place of a cell.
  const Place& place(std::uint32_t cell) const { return place_[cell]; }
  /// A cell's points.
  const PlanarSample* begin(std::uint32_t cell) const { return points_.data() + begin_[cell]; }
  /// Behind a cell's points.
  const PlanarSample* end(std::uint32_t cell) const { return points_.data() + begin_[cell + 1]; }

  /// Whether two points of two blocks that have no cell in common are closer than `distance` [m], which is no less than
  /// a cell's diagonal. Linear in the points of each pair of cells whose extents do not tell, n log n for a cell's
  /// first such comparison.
  bool areCloser(Block a, Block b, float distance);

  /// Points looked at by comparisons since clear(), for tests that bound the work.
  std::size_t pointsLookedAt() const { return looked_at_; }

private:
  struct Range
  {
    std::uint32_t begin, end;  ///< of points_
    std::uint64_t size() const { return end - begin; }
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

  Range rangeOf(Block block) const { return {begin_[block.begin], begin_[block.end]}; }
  bool areCellsCloser(std::uint32_t a, std::uint32_t b, float distance);
  bool isAnyPairCloser(Range a, Range b, float squared_distance);
  bool isGreedyPairCloser(Range a, Range b, const Box& box_b, float squared_distance);
  bool reachesOver(std::uint32_t low, std::uint32_t high, bool along_y, float distance);
  void drawEnvelope(std::uint32_t cell, bool along_y, double distance);
  const PlanarSample& nearest(Range range, float x, float y);
  const Box& boxOf(std::uint32_t cell);
  Box boxOf(Block block);
  static float squaredGap(const Box& p, const Box& q);
  static float squaredSpan(const Box& p, const Box& q);
  const PlanarSample* sorted(std::uint32_t cell, bool along_y);

  std::vector<PlanarSample> points_;
  std::vector<std::uint32_t> begin_;                    ///< by cell, one entry more
  std::vector<Place> place_;                            ///< by cell
  std::vector<Box> boxes_;                              ///< by cell; min above max until it is asked for
  std::array<std::vector<std::uint8_t>, 2> is_sorted_;  ///< by cell: whether it is in sorted_
  std::array<std::vector<PlanarSample>, 2> sorted_;     ///< points_, each cell's along x and along y
  std::vector<Arc> envelope_;
  std::size_t looked_at_ = 0;
};
}  // namespace lidar_panoptic_clustering
