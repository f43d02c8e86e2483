#pragma once

#include "lidar_panoptic_clustering/projection/beam_table.h"
#include "lidar_panoptic_clustering/projection/ring_order.h"
#include "lidar_panoptic_clustering/projection/sweep_finder.h"

#include <cstdint>
#include <optional>
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

  /// The number of beams of a sensor whose highest ring seen is `highest`: drivers leave out what did not return, and
  /// beams that look into the sky are at one end of the numbers. So it is the nearest number of beams above that
  /// spinning lidars have, 16, 32, 40, 64, 80 or 128; beyond, `highest` and one. A sensor with another number of beams
  /// gets rows that stay empty, which cost memory and nothing else.
  static std::uint32_t beamsOf(std::uint32_t highest);

  /// By the rings' numbers, one a point, in whatever order they are numbered, see RingOrder. `rows`: those of the
  /// sensor, 0 where they are not known: beamsOf() the highest, at least `least`. Throws std::invalid_argument for a
  /// ring beyond, and for numbers that say nothing about the elevation.
  std::uint32_t byRing(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& ring_of_point,
                       std::uint32_t rows, std::uint32_t least = 0);

  /// By the nearest beam. The points have to be in the sensor's own frame. Throws std::invalid_argument where they lie
  /// anywhere between the beams, so that these cannot be the sensor's.
  std::uint32_t byBeam(const std::vector<ScanPoint>& scan, const BeamTable& beams);

  /// By the order of the points, see unfoldScan(). `rows` as above, and where they are not known as many as rings came,
  /// at least `least`; further rings go into the last row, so that no point is lost. `sweep` is tried first where it is
  /// given, then what SweepFinder finds, which it becomes.
  std::uint32_t byUnfolding(const std::vector<ScanPoint>& scan, std::uint32_t rows, std::uint32_t least,
                            std::optional<Sweep>& sweep);

  /// Whether the points of the scan unfolded last did come ring after ring: they fell into 2 to 256 rings (at most
  /// `rows` where these are known, and at least half of them), the azimuth goes the sweep's way and changes more than
  /// the elevation, that steps where rings begin, and their elevations fall or rise all the way, or each ring has one
  /// of its own.
  bool cameRingAfterRing(std::uint32_t rows) const;

  /// Of the last scan, by point.
  const std::vector<PointDirection>& directions() const { return directions_; }
  /// Of the last scan.
  const RingOrder& order() const { return order_; }

  /// Firings a turn by the usual gap of azimuth in the scan line of the last scan with most returns, which does not
  /// care about sectors and missing returns; 0 where that line has hardly any.
  double firingsOfTurn();

  /// The columns that fit so many firings: the smallest power of two that has nine tenths of a column a firing, 16 to
  /// 16384. HDL-64E, VLP-16, VLP-32C, HDL-32E and Pandar64 at 10 Hz have 2048 then.
  static std::uint32_t columnsFor(double firings);

  /// By how much of a column the azimuths have to move so that firings fall into columns and not on their borders: 0.5
  /// where most lie there, else 0. Looks at about a thousand points.
  float columnShift(std::uint32_t columns) const;

  /// Forgets the elevations of rings that earlier scans had.
  void forget() { order_.forget(); }

private:
  void unfold(const std::vector<ScanPoint>& scan, const Sweep& sweep);
  void countElevationSteps(const std::vector<ScanPoint>& scan);
  std::uint32_t fullestRow();
  void orderRings(const std::vector<ScanPoint>& scan, std::uint32_t rings, bool remember);

  RingOrder order_;
  SweepFinder sweeps_;
  std::uint32_t unfolded_rings_ = 0, elevation_steps_ = 0;  ///< steps: where a ring begins
  std::uint32_t forward_ = 0, backward_ = 0;                ///< small steps in the sense of the sweep, of a sample
  std::uint32_t climbs_ = 0;                                ///< steps, of it, that go up or down more than along
  std::vector<PointDirection> directions_;
  std::vector<std::uint32_t> returns_of_row_;
  std::vector<float> azimuths_, steps_;
};
}  // namespace lidar_panoptic_clustering
