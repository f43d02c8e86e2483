#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Finds out by their elevations which row each ring of a scan is, however the rings are numbered.
///
/// Looks at one point in 13, so that firings of any usual number of lasers show all of them. Buffers are kept.
class RingOrder
{
public:
  /// `directions`: one a point, `row` being the ring, below `rings`. Linear.
  void look(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions, std::uint32_t rings);

  /// By ring: its row, 0 for the highest. Numbers that rise or fall with the elevation keep their sequence, rings
  /// without a return included; others (lasers numbered as they fire) go by their mean elevation, unless this is too
  /// blurred to tell two rings apart.
  const std::vector<std::uint32_t>& rowOfRing() const { return row_of_ring_; }

  /// Whether the elevations fall (or rise) from ring to ring through the whole scan: the mark of a file whose rings
  /// come one after another. Nine in ten steps go that way, and none goes back by a quarter of the whole.
  bool isMonotone() const;

private:
  struct Ring
  {
    double sum = 0.0, sum_of_squares = 0.0;  ///< of the elevation's sine
    std::uint32_t count = 0;
    double mean() const { return sum / count; }
  };
  void sum(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions, std::uint32_t rings);
  void countSteps();
  bool canBeSorted() const;
  void sortByElevation();

  std::vector<Ring> rings_;
  int falls_ = 0, rises_ = 0;  ///< steps from one ring that was seen to the next
  double largest_fall_ = 0.0, largest_rise_ = 0.0, lowest_ = 0.0, highest_ = 0.0;
  std::vector<std::uint32_t> row_of_ring_, ring_of_row_;
  std::vector<double> elevation_;  ///< by ring; of rings not seen, the one before's
};
}  // namespace lidar_panoptic_clustering
