#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The cheapest assignment of rows to columns where few pairs are allowed, exact: shortest augmenting paths with
/// potentials [Jonker and Volgenant 1987], each found by Dijkstra's algorithm over the pairs there are.
///
/// A row may stay without a column, at a price of its own. With pairs only between neighbours a path ends after a few
/// steps, which makes the whole linear in practice; at worst it takes rows * pairs * log(pairs). Keeps its memory.
class SparseAssignment
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;  ///< the column of a row that stays alone

  /// Begins a problem without pairs.
  void reset(std::size_t columns);
  /// Begins the next row, which stays without a column at the price `alone`, at least 0.
  void addRow(float alone);
  /// Allows the row begun last to take `column` at `cost`, at least 0. A column at most once a row.
  void addPair(std::uint32_t column, float cost);

  /// Each row's column, kNone for none; valid until the next reset. Of equally cheap assignments one that depends only
  /// on the order in which rows and pairs were added.
  const std::vector<std::uint32_t>& solve();

private:
  struct Pair
  {
    std::uint32_t column;
    double cost;
  };
  struct Open
  {
    double distance;
    std::uint32_t column;
    bool operator<(const Open& other) const
    {
      return distance != other.distance ? distance > other.distance : column > other.column;
    }
  };
  struct Path
  {
    double length;
    std::uint32_t column;  ///< kNone: ends at a row that stays alone
    std::uint32_t row;     ///< that row
  };

  Path search(std::uint32_t row);
  void relax(std::uint32_t row, double offset, Path& best);
  void augment(std::uint32_t row, const Path& path);

  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> begin_;  ///< by row, into pairs_
  std::vector<double> alone_;
  std::vector<double> potential_;  ///< by column, as are the next four
  std::vector<std::uint32_t> row_of_, reached_from_, reached_in_, settled_in_;
  std::vector<double> distance_;
  std::vector<std::uint32_t> column_of_;  ///< by row
  std::vector<Open> open_;                ///< a heap, the nearest on top
  std::vector<std::uint32_t> settled_;
  std::uint32_t round_ = 0;
};
}  // namespace lidar_panoptic_clustering
