#pragma once

#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstddef>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Points without scan lines as a range image: of a lidar whose pattern does not repeat, of several lidars merged, or
/// of a cloud that came through a filter.
///
/// The rows are steps of elevation over what is seen (all but a thousandth of the returns at either end), the columns
/// steps of azimuth over a turn; as many pixels as returns where there are any, 2.25 times finer along the rows than
/// across, as lidars are. Of points that share a pixel it shows the nearest. Several lidars are seen from the origin of
/// their common frame, from where some points hide others that neither of the lidars found in its way.
///
/// Buffers are kept between scans; not shared between threads.
class PolarView
{
public:
  /// Row 0 is the highest. The view's points are `points`; labels are 0. Valid until the next call. Linear.
  OrganizedScan& of(const std::vector<ScanPoint>& points);

private:
  struct Extent
  {
    float lowest = 0.0F, highest = 0.0F;  ///< elevation [rad]
    float turn = 0.0F;                    ///< azimuth in which there is anything [rad]
    std::size_t returns = 0;
  };
  Extent measure(const std::vector<ScanPoint>& points);

  std::vector<PointDirection> directions_;
  std::vector<float> elevation_;  ///< by point
  DirectionProjector projector_;
  OrganizedScan view_;
};
}  // namespace lidar_panoptic_clustering
