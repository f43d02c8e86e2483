#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/projection/scan_unfolding.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How the elevation changes from one return to the next where a new ring begins: less than within a firing of the
/// finest sensor there is, more than rounding. Of its sine.
constexpr float kElevationStep = 9e-4F;

/// The usual change of the elevation's sine from return to return, the median of `steps`, which it reorders; 0 where
/// there are none. Beams beside the axis, noise and tilted frames make it.
float usualStep(std::vector<float>& steps);

/// Finds out which way, and from where, the rings of a scan run whose points come ring after ring.
///
/// The sense is that of most small steps of the azimuth. From the last return of a ring to the first of the next one
/// the elevation steps, and the arc between them holds the azimuth at which all rings begin: that azimuth lies in more
/// such arcs than any other. Steps of the elevation within a ring (beams that start beside the axis) have short arcs
/// all over the turn. Buffers are kept; not shared between threads.
class SweepFinder
{
public:
  /// Empty where the azimuth goes no way most of the time. Says nothing about whether the points do come ring after
  /// ring: that shows once they are unfolded. Linear.
  std::optional<Sweep> find(const std::vector<ScanPoint>& scan);

private:
  static constexpr std::uint32_t kBins = 4096;  // of the turn: a column of the finest sensor there is

  static constexpr std::uint32_t kOverlap = kBins / 20;  // as the counter of rings lets points step back

  struct Return
  {
    float azimuth, sine;
  };

  void gather(const std::vector<ScanPoint>& scan);
  std::optional<bool> goesClockwise() const;
  float leastStep();
  void countArcs(bool clockwise);
  Sweep bestStart(bool clockwise) const;

  std::vector<Return> returns_;
  std::vector<float> steps_;
  std::vector<std::int32_t> arcs_;  ///< by bin of the azimuth in the sense of the sweep: arcs that hold it
};
}  // namespace lidar_panoptic_clustering
