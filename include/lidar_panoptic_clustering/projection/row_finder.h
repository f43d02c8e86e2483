#pragma once

#include "lidar_panoptic_clustering/projection/beam_table.h"
#include "lidar_panoptic_clustering/projection/ring_order.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Finds the scan line and the azimuth of each point of a cloud that is not organised.
///
/// Each way of it fills directions() and returns the number of rows, the highest scan line being row 0; linear. Buffers
/// are kept between scans; not shared between threads.
class RowFinder
{
public:
  /// Rings there can be; more are taken for a field that holds something else.
  static constexpr std::uint32_t kMaxRings = 1024;

  /// By the rings' numbers, one a point, in whatever order they are numbered, see RingOrder. `rows`: those of the
  /// sensor, 0 where they are not known: the highest number and one. Throws std::invalid_argument for a ring beyond.
  std::uint32_t byRing(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& ring_of_point,
                       std::uint32_t rows);

  /// By the nearest beam. The points have to be in the sensor's own frame.
  std::uint32_t byBeam(const std::vector<ScanPoint>& scan, const BeamTable& beams);

  /// By the order of the points, see unfoldScan(). `rows` as above; further rings go into the last row, so that no
  /// point is lost.
  std::uint32_t byUnfolding(const std::vector<ScanPoint>& scan, std::uint32_t rows);

  /// Whether the points of the scan do come ring after ring: they fall into 2 to 256 rings (at most `rows` where these
  /// are known, and at least half of them), whose elevations fall or rise all the way.
  bool canBeUnfolded(const std::vector<ScanPoint>& scan, std::uint32_t rows);

  /// Of the last scan, by point.
  const std::vector<PointDirection>& directions() const { return directions_; }

  /// The columns of a turn that fit the last scan: the smallest power of two that has nine tenths of a column a firing,
  /// 16 to 16384. Firings are counted by the usual gap of azimuth in the scan line with most returns, which does not
  /// care about sectors and missing returns. HDL-64E, VLP-16, VLP-32C, HDL-32E and Pandar64 at 10 Hz have 2048 then.
  std::uint32_t columnsOfTurn();

private:
  void orderRings(const std::vector<ScanPoint>& scan, std::uint32_t rings);

  RingOrder order_;
  std::vector<PointDirection> directions_;
  std::vector<std::uint32_t> returns_of_row_;
  std::vector<float> azimuths_;
};
}  // namespace lidar_panoptic_clustering
